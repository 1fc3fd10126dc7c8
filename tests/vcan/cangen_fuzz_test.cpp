// SPDX-License-Identifier: Apache-2.0
#include "drives_on_vcan.hpp"
#include "override_frame/override_receiver.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::vcan;
using cia402::Reject;
using override_frame::ReceiveError;

namespace {

constexpr float largest_ratio = 1.5F;
constexpr int frames_per_cangen = 1000;  // as many as the socket holds: none is lost, however busy this machine is

/// All ids and lengths by chance, and more of those that the receivers look at.
constexpr std::array<const char*, 14> cangen_options{
    "-I r -L r -D r",    "-I 1FE -L 8 -D r", "-I 1FE -L r -D r", "-I 77E -L r -D r", "-I 181 -L r -D r",
    "-I 182 -L 8 -D r",  "-I 080 -L r -D r", "-I 081 -L r -D r", "-I 701 -L r -D r", "-I 702 -L 1 -D i",
    "-e -I r -L r -D r", "-R -I r",          "-I i -L i -D i",   "-I 080 -L 0"};

/// MILLFORCE_CANGEN_FRAMES, 20 000 where it is not set; in rounds, one with each options at least.
int cangen_rounds() {
    const char* given = std::getenv("MILLFORCE_CANGEN_FRAMES");
    const int frames = given != nullptr ? std::atoi(given) : 20'000;
    return std::max(frames / frames_per_cangen, static_cast<int>(cangen_options.size()));
}

/// Half of it is longer than any two of cangen's frames are apart, on the slowest emulated controller too: a second
/// SYNC is early.
constexpr std::uint32_t sync_period_us = 50'000;

cia402::BusSettings listener_settings() {
    cia402::BusSettings settings = bus_settings(2, sync_period_us);
    settings.is_master = false;
    for (std::size_t role = 0; role < 2; ++role) {
        settings.drives[role].rated_current_A = 12.0F;
        settings.drives[role].heartbeat_timeout_us = 0;
    }
    return settings;
}

bool is_plain(const hal::CanFrame& frame) {
    return !frame.extended && !frame.remote;
}

/// What a drive's bus may use: its objects with the length that they have.
bool is_sound_to_the_bus(const hal::CanFrame& frame) {
    if (!is_plain(frame)) {
        return false;
    }
    switch (frame.id) {
        case 0x080:
            return frame.length <= 1;
        case 0x081:
        case 0x082:
        case 0x181:
        case 0x182:
            return frame.length == 8;
        case 0x701:
        case 0x702:
            return frame.length == 1;
        default:
            return false;
    }
}

class FuzzedReceivers {
  public:
    FuzzedReceivers() : bus_(listener_settings()), receiver_(receiver_settings()) {}

    void take(const hal::CanFrame& frame, std::uint64_t time_us) {
        ++frames;
        to_the_bus(frame, time_us);
        to_the_cnc(frame, time_us);
    }
    /// The drives run and a sample is open: else a PDO is late or not to be looked at, whatever its length.
    void begin_round(std::uint64_t time_us) {
        hal::CanFrame frame;
        frame.length = 1;
        frame.data[0] = 0x05;
        for (const std::uint32_t id : {0x701U, 0x702U}) {
            frame.id = id;
            bus_.on_frame(frame, time_us);
        }
        frame.id = 0x080;
        frame.length = 0;
        bus_.on_frame(frame, time_us);
    }
    [[nodiscard]] std::uint32_t rejected(Reject reason) const { return bus_.rejects()[reason]; }
    [[nodiscard]] std::uint32_t rejected(ReceiveError reason) const { return receiver_.errors(reason); }

    int frames = 0;
    int rejected_by_bus = 0;
    int rejected_by_cnc = 0;

  private:
    static override_frame::OverrideReceiverSettings receiver_settings() {
        override_frame::OverrideReceiverSettings settings;
        settings.largest_ratio = largest_ratio;
        return settings;
    }
    [[nodiscard]] std::uint64_t bus_rejects() const {
        return bus_.rejects().total() + bus_.rejects()[Reject::foreign_id];
    }
    [[nodiscard]] std::uint64_t cnc_rejects() const {
        std::uint64_t sum = 0;
        for (std::size_t k = 0; k < override_frame::receive_errors; ++k) {
            sum += receiver_.errors(static_cast<ReceiveError>(k));
        }
        return sum;
    }
    void to_the_bus(const hal::CanFrame& frame, std::uint64_t time_us) {
        const std::uint64_t before = bus_rejects();
        bus_.on_frame(frame, time_us);
        const bool counted = bus_rejects() > before;
        rejected_by_bus += counted ? 1 : 0;
        CHECK(counted || is_sound_to_the_bus(frame));
        bus_.poll(time_us);
        hal::DriveSample sample;
        if (bus_.take_sample(sample)) {
            CHECK(sample.spindle_current_A <= 48.0F && sample.spindle_current_A >= -48.0F);
        }
    }
    void to_the_cnc(const hal::CanFrame& frame, std::uint64_t time_us) {
        const std::uint64_t before = cnc_rejects();
        receiver_.on_frame(frame, time_us);
        const bool counted = cnc_rejects() > before;
        rejected_by_cnc += counted ? 1 : 0;
        hal::FeedOverride decoded;
        if (is_plain(frame) && frame.id == override_frame::default_id && !counted) {
            CHECK(override_frame::decode(frame, frame.id, decoded) == override_frame::FrameError::none);
            CHECK(decoded.ratio <= largest_ratio);
        }
        const override_frame::ReceivedOverride now = receiver_.current(time_us);
        CHECK(now.ratio >= 0.0F && now.ratio <= largest_ratio);
        CHECK(now.is_alive || (now.hold && now.ratio <= 0.0F));
    }

    cia402::DriveBus bus_;
    override_frame::OverrideReceiver receiver_;
};

}  // namespace

TEST_GROUP(CangenFuzz){};

TEST(CangenFuzz, each_frame_is_sound_or_counted_by_its_reason_and_no_override_is_above_its_bound) {
    Listener listener(on(controller_interface()));
    CHECK(listener.socket.is_up());
    FuzzedReceivers receivers;
    const int rounds = cangen_rounds();
    for (int round = 0; round < rounds; ++round) {
        const char* options = cangen_options[static_cast<std::size_t>(round) % cangen_options.size()];
        Child cangen("cangen " + peer_interface() + " -g 0 -p 10 -n " + std::to_string(frames_per_cangen) + " " +
                     options);
        while (!cangen.has_ended()) {
            listener.run_ms(2);
        }
        listener.run_ms(2);
        if (!listener.times_us.empty()) {
            receivers.begin_round(listener.times_us.front());
        }
        for (std::size_t k = 0; k < listener.frames.size(); ++k) {
            receivers.take(listener.frames[k], listener.times_us[k]);
        }
        listener.frames.clear();
        listener.times_us.clear();
    }
    std::printf(
        "\n    cangen: %d frames, %d rejected by the drive bus, %d by the CNC, %u overruns, %u of the controller\n",
        receivers.frames, receivers.rejected_by_bus, receivers.rejected_by_cnc, listener.socket.health().overruns,
        listener.socket.health().controller_overflows);
    // The emulated SJA1000 overflows on remote frames: a fault of a controller for real, told to the last frame.
    UNSIGNED_LONGS_EQUAL(rounds * frames_per_cangen, static_cast<unsigned>(receivers.frames) +
                                                         listener.socket.health().overruns +
                                                         listener.socket.health().controller_overflows);
    CHECK(receivers.frames > rounds * frames_per_cangen / 2);
    for (const Reject reason : {Reject::foreign_id, Reject::not_standard_data, Reject::pdo_length, Reject::sync_length,
                                Reject::emergency_malformed, Reject::heartbeat_malformed, Reject::sync_early}) {
        CHECK_TEXT(receivers.rejected(reason) > 0, std::to_string(static_cast<int>(reason)).c_str());
    }
    for (const ReceiveError reason :
         {ReceiveError::length, ReceiveError::checksum, ReceiveError::heartbeat_malformed}) {
        CHECK(receivers.rejected(reason) > 0);
    }
}
