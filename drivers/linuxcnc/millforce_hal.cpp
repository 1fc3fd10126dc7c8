// SPDX-License-Identifier: GPL-2.0-or-later
// millforce-hal: the bridge between LinuxCNC's HAL and the force controller. Takes the samples of the real-time
// component millforce_sample, sends them to `millforce serve` over a Unix socket (drivers/local_link), and writes the
// answers to its pins. It decides nothing: if it or the controller stops, the pin `heartbeat` stops counting, and
// millforce_guard in the servo thread does the rest.
#include <fcntl.h>
#include <poll.h>
#include <strings.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include <hal.h>

#include "local_link/messages.hpp"
#include "millforce_program.h"
#include "millforce_stream.h"

namespace {

using namespace millforce::local_link;

constexpr const char* component_name = "millforce";
constexpr long wait_ns = 250'000;  // the HAL stream cannot wake a reader: it is polled four times per millisecond
constexpr std::uint64_t connect_every_us = 100'000;
constexpr int most_unanswered = 128;  // half of what a socket holds: neither side ever finds it full

/// In HAL's shared memory, and nowhere else: linking a pin to a signal moves the pointer here.
struct Pins {
    hal_float_t* ratio;
    hal_u32_t* heartbeat;
    hal_bit_t* hold;
    hal_bit_t* connected;
    hal_u32_t* answered;
    hal_u32_t* state;
    hal_u32_t* fault;
    hal_u32_t* limit;
    hal_float_t* tangential_force;
    hal_float_t* feed_force;
    hal_float_t* tooth_force;
    hal_bit_t* force_valid;
    hal_float_t* immersion;
    hal_float_t* immersion_sd;
    hal_bit_t* immersion_valid;
    hal_float_t* depth;
    hal_float_t* depth_sd;
    hal_bit_t* depth_valid;
    hal_bit_t* tool_unknown;
    hal_u32_t* dropped;
    hal_float_t* mm_per_unit;
};

int export_pins(Pins& p, int component) {
    const auto f32 = [&](hal_float_t** pin, const char* name) {
        return hal_pin_float_newf(HAL_OUT, pin, component, "%s.%s", component_name, name);
    };
    const auto u32 = [&](hal_u32_t** pin, const char* name) {
        return hal_pin_u32_newf(HAL_OUT, pin, component, "%s.%s", component_name, name);
    };
    const auto bit = [&](hal_bit_t** pin, const char* name) {
        return hal_pin_bit_newf(HAL_OUT, pin, component, "%s.%s", component_name, name);
    };
    const int failed = f32(&p.ratio, "override") | u32(&p.heartbeat, "heartbeat") | bit(&p.hold, "hold") |
                       bit(&p.connected, "connected") | u32(&p.answered, "answered") | u32(&p.state, "state") |
                       u32(&p.fault, "fault") | u32(&p.limit, "limit") | f32(&p.tangential_force, "tangential-force") |
                       f32(&p.feed_force, "feed-force") | f32(&p.tooth_force, "tooth-force") |
                       bit(&p.force_valid, "tooth-force-valid") | f32(&p.immersion, "immersion") |
                       f32(&p.immersion_sd, "immersion-sd") | bit(&p.immersion_valid, "immersion-valid") |
                       f32(&p.depth, "depth") | f32(&p.depth_sd, "depth-sd") | bit(&p.depth_valid, "depth-valid") |
                       bit(&p.tool_unknown, "tool-unknown") | u32(&p.dropped, "dropped") |
                       f32(&p.mm_per_unit, "mm-per-unit");
    if (failed == 0) {
        *p.hold = true;
    }
    return failed;
}

SampleMessage message_of(const std::array<hal_stream_data, MILLFORCE_FIELDS>& row) {
    const auto f32 = [&](std::size_t field) { return static_cast<float>(row[field].f); };
    const unsigned flags = row[MILLFORCE_FLAGS].u;
    SampleMessage m;
    m.sequence = row[MILLFORCE_CYCLE].u;
    m.time_us = row[MILLFORCE_TIME_US].u;
    m.spindle_count = row[MILLFORCE_COUNT].u;
    m.spindle_index_count = row[MILLFORCE_INDEX_COUNT].u;
    m.spindle_index_number = static_cast<std::uint8_t>(row[MILLFORCE_INDEX_NUMBER].u);
    m.present = static_cast<std::uint8_t>(flags);
    m.rapid = (flags & MILLFORCE_RAPID) != 0;
    m.feed_hold = (flags & MILLFORCE_FEED_HOLD) != 0;
    m.reset = (flags & MILLFORCE_RESET) != 0;
    m.spindle_current_A = f32(MILLFORCE_SPINDLE_CURRENT);
    m.axis_current_A = {f32(MILLFORCE_X_CURRENT), f32(MILLFORCE_Y_CURRENT), f32(MILLFORCE_Z_CURRENT)};
    m.axis_velocity_mm_s = {f32(MILLFORCE_X_VELOCITY), f32(MILLFORCE_Y_VELOCITY), f32(MILLFORCE_Z_VELOCITY)};
    m.programmed_feed_mm_s = f32(MILLFORCE_FEED);
    m.operator_limit = f32(MILLFORCE_OPERATOR_LIMIT);
    m.line = row[MILLFORCE_LINE].u;
    m.distance_to_go_mm = f32(MILLFORCE_DISTANCE_TO_GO);
    m.tool = row[MILLFORCE_TOOL].u;
    m.commanded_speed_rad_s = f32(MILLFORCE_COMMANDED_SPEED);
    return m;
}

/// Other HAL components use a pin's value as a number: without an estimate it is 0, and its valid pin is false.
void set_estimate(float value, hal_float_t* pin, hal_bit_t* valid) {
    const bool is_there = value - value == 0.0F;
    *pin = is_there ? static_cast<real_t>(value) : 0;
    if (valid != nullptr) {
        *valid = is_there;
    }
}

void set_pins(const Pins& p, const OverrideMessage& m) {
    *p.ratio = static_cast<real_t>(m.ratio);
    *p.hold = m.hold;
    *p.state = m.state;
    *p.fault = m.fault;
    *p.limit = m.limit;
    *p.tool_unknown = m.tool_unknown;
    set_estimate(m.tangential_N, p.tangential_force, nullptr);
    set_estimate(m.feed_N, p.feed_force, nullptr);
    set_estimate(m.tooth_force_N, p.tooth_force, p.force_valid);
    set_estimate(m.radial_immersion, p.immersion, p.immersion_valid);
    set_estimate(m.radial_immersion_sd, p.immersion_sd, nullptr);
    set_estimate(m.axial_depth_mm, p.depth, p.depth_valid);
    set_estimate(m.axial_depth_sd_mm, p.depth_sd, nullptr);
    *p.heartbeat = m.heartbeat;
    *p.answered = m.sequence;  // last: a reader that sees it also sees the rest
}

class Bridge {
  public:
    Bridge(const sockaddr_un& address, hal_stream_t& stream, const Pins& pins)
        : address_(address), stream_(stream), pins_(pins) {}
    ~Bridge() { disconnect(); }
    Bridge(const Bridge&) = delete;
    Bridge& operator=(const Bridge&) = delete;

    void step() {
        if (socket_ < 0) {
            connect_now_and_then();
        }
        forward_samples();
        await_answers();
    }

  private:
    void connect_now_and_then() {
        const std::uint64_t now_us = monotonic_us();
        if (now_us < next_connect_us_) {
            return;
        }
        next_connect_us_ = now_us + connect_every_us;
        socket_ = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        if (socket_ >= 0 && connect(socket_, reinterpret_cast<const sockaddr*>(&address_), sizeof address_) != 0) {
            disconnect();
        }
    }

    void disconnect() {
        if (socket_ >= 0) {
            close(socket_);
        }
        socket_ = -1;
        unanswered_ = 0;
        *pins_.connected = false;
    }

    /// This program never waits. Samples that the controller has not taken yet stay in the stream; millforce_sample
    /// counts those that do not fit. Without a controller samples are dropped.
    void forward_samples() {
        std::array<hal_stream_data, MILLFORCE_FIELDS> row{};
        unsigned number = 0;
        while (unanswered_ < most_unanswered && hal_stream_readable(&stream_) &&
               hal_stream_read(&stream_, row.data(), &number) == 0) {
            if (socket_ < 0) {
                continue;
            }
            const SampleBytes bytes = encode(message_of(row));
            if (send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) >= 0) {
                ++unanswered_;
                continue;
            }
            *pins_.dropped = *pins_.dropped + 1;
            if (errno != EAGAIN) {
                disconnect();
            }
        }
    }

    void await_answers() {
        pollfd descriptor{socket_, POLLIN, 0};
        const timespec wait{0, wait_ns};
        ppoll(&descriptor, 1, &wait, nullptr);  // a negative descriptor only waits
        std::array<std::uint8_t, override_bytes + 1> bytes{};
        while (socket_ >= 0) {
            const ssize_t length = recv(socket_, bytes.data(), bytes.size(), 0);
            if (length < 0 && (errno == EAGAIN || errno == EINTR)) {
                return;
            }
            if (length <= 0) {
                disconnect();
                return;
            }
            take(std::span<const std::uint8_t>(bytes).first(static_cast<std::size_t>(length)));
        }
    }

    void take(std::span<const std::uint8_t> bytes) {
        OverrideMessage message;
        const MessageError error = decode(bytes, message);
        if (error != MessageError::none) {
            fprintf(stderr, "millforce-hal: an answer is not sound (%s): is the controller of another version?\n",
                    name(error));
            disconnect();
            return;
        }
        --unanswered_;
        set_pins(pins_, message);
        // Not before: samples of before the connection are never answered, whoever waits for an answer would wait in
        // vain.
        *pins_.connected = true;
    }

    sockaddr_un address_;
    hal_stream_t& stream_;
    const Pins& pins_;
    int socket_ = -1;
    int unanswered_ = 0;
    std::uint64_t next_connect_us_ = 0;
};

/// By [TRAJ]LINEAR_UNITS of the INI file, in the words that LinuxCNC takes; 0: another word.
real_t mm_per_unit_of(const char* linear_units) {
    for (const char* word : {"mm", "metric"}) {
        if (strcasecmp(linear_units, word) == 0) {
            return 1.0;
        }
    }
    for (const char* word : {"inch", "in", "imperial"}) {
        if (strcasecmp(linear_units, word) == 0) {
            return 25.4;
        }
    }
    return 0.0;
}

bool set_address(const char* path, sockaddr_un& address) {
    address.sun_family = AF_UNIX;
    const std::size_t length = strlen(path);
    if (length == 0 || length >= sizeof address.sun_path) {
        return false;
    }
    memcpy(address.sun_path, path, length + 1);
    return true;
}

int run(int component, const sockaddr_un& address, real_t mm_per_unit) {
    auto* pins = static_cast<Pins*>(hal_malloc(sizeof(Pins)));
    if (pins == nullptr || export_pins(*pins, component) != 0) {
        fprintf(stderr, "millforce-hal: no memory for HAL pins\n");
        return 1;
    }
    *pins->mm_per_unit = mm_per_unit;
    hal_stream_t stream{};
    if (hal_stream_attach(&stream, component, MILLFORCE_STREAM_KEY, MILLFORCE_STREAM_TYPES) < 0) {
        fprintf(stderr, "millforce-hal: no samples: load millforce_sample first ('loadrt millforce_sample')\n");
        return 1;
    }
    hal_ready(component);
    {
        Bridge bridge(address, stream, *pins);
        while (stop_asked == 0) {
            bridge.step();
        }
    }
    hal_stream_detach(&stream);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    sockaddr_un address{};
    if (argc != 3 || !set_address(argv[1], address)) {
        fprintf(stderr,
                "usage: millforce-hal SOCKET UNITS    the socket of 'millforce serve', at most %zu characters, and "
                "[TRAJ]LINEAR_UNITS\n",
                sizeof address.sun_path - 1);
        return 2;
    }
    const real_t mm_per_unit = mm_per_unit_of(argv[2]);
    if (mm_per_unit == 0.0) {
        fprintf(stderr, "millforce-hal: [TRAJ]LINEAR_UNITS = %s: expected mm or inch\n", argv[2]);
        return 2;
    }
    ask_to_stop_on_signals();
    const int component = hal_init(component_name);
    if (component < 0) {
        fprintf(stderr, "millforce-hal: no HAL: is LinuxCNC running, and no other millforce-hal?\n");
        return 1;
    }
    const int result = run(component, address, mm_per_unit);
    hal_exit(component);
    return result;
}
