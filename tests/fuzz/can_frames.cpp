// SPDX-License-Identifier: Apache-2.0
// A sequence of CAN frames with their times, into the controller of `millforce run`: one that has just begun, and one
// whose drives run and whose CNC is alive.
//
// The first byte chooses the controller. Then, for each frame: the time since the last one, the id, shape and data. The
// controller has its part map over the bus, and a bit of the shape gives a frame of it a checksum that is right.
#include "firmware/can/controller_on_loopback.hpp"
#include "firmware/tool_checksum.hpp"
#include "firmware_can/way_over_bus.hpp"
#include "fuzz/hostile_bytes.hpp"
#include "hal/finite.hpp"
#include "override_frame/override_frame.hpp"

using namespace millforce;

namespace {

void require_bounded(const hal::FeedOverride& output, float most) {
    fuzz::require(hal::is_finite(output.ratio) && output.ratio >= 0.0F, "the override is a number");
    fuzz::require(output.ratio <= most, "the override is at most the machine's");
}

/// Checks each tick.
class TickCheck final : public firmware::TickListener {
  public:
    explicit TickCheck(float most) : most_(most) {}

    void on_tick(const firmware::CanController& controller) override {
        require_bounded(controller.output(), most_);
        require_bounded(controller.sent_override(), most_);
        const hal::DriveSample& sample = controller.sample();
        bool are_finite = hal::is_finite(sample.spindle_current_A);
        for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
            are_finite = are_finite && hal::is_finite(sample.axis_current_A[axis]) &&
                         hal::is_finite(sample.axis_velocity_mm_s[axis]);
        }
        fuzz::require(are_finite, "what the drives say is finite");
    }

  private:
    float most_;
};

/// Controllers to be copied: to make one takes milliseconds.
struct Controllers {
    sim::Scenario scenario = sim::read_scenario(MILLFORCE_SOURCE_DIR "/sim/scenarios/depth_ramp.toml");
    firmware::CanControllerSettings settings =
        test::controller_settings(host::read_machine_bus(scenario.machine_file).value());
    float most = scenario.parameters.machine.cnc.override_max;
    TickCheck check{most};
    firmware::WayOverBus<float> new_way{scenario.parameters, firmware::tool_checksum(scenario.parameters.tool),
                                        settings.feed_override.node_id};
    firmware::WayOverBus<float> way = new_way;  ///< of the controller in work
    firmware::CanController starting{settings, scenario.parameters, &check, nullptr, &way};
    firmware::CanController running{settings, scenario.parameters, &check, nullptr, &way};
    std::uint64_t now_us = 0;

    Controllers() {
        test::ControllerOnLoopback bench(scenario);
        for (std::uint32_t k = 0; k < 500; ++k) {
            bench.step(test::turning_in_air(k), {});
        }
        for (const test::LoggedFrame& logged : bench.log) {
            running.on_frame(logged.frame, logged.time_us, logged.is_own);
            running.poll(logged.time_us);
            hal::CanFrame sent;
            while (running.take_frame(sent)) {  // it is in the log
            }
        }
        fuzz::require(running.ticks() > 100, "the prepared controller runs");
        now_us = bench.now_us;
        hal::CanFrame boot_up;
        starting.poll(now_us);
        fuzz::require(starting.take_frame(boot_up), "a controller says that it starts");
        starting.on_frame(boot_up, now_us, true);
    }
};

std::uint32_t tool_checksum() {
    static const std::uint32_t checksum = firmware::tool_checksum(
        sim::read_scenario(MILLFORCE_SOURCE_DIR "/sim/scenarios/depth_ramp.toml").parameters.tool);
    return checksum;
}

/// A session of the controller's own tool begins where it otherwise hardly ever would.
hal::CanFrame way_frame(const hal::CanFrame& from) {
    way_window::WayFrame frame{from.data[0],
                               static_cast<std::uint8_t>(from.data[1] & 0x07U),
                               static_cast<std::uint8_t>(from.data[1] >> 4U),
                               {}};
    std::copy_n(from.data.begin() + 2, way_window::payload_bytes, frame.payload.begin());
    if (frame.kind == static_cast<std::uint8_t>(way_window::WayFrameKind::begin)) {
        frame = way_window::begin_frame(frame.session, frame.number, tool_checksum());
    }
    return way_window::encode(frame, way_window::way_frame_id(override_frame::default_node_id));
}

hal::CanFrame next_frame(fuzz::Bytes& bytes, std::span<const hal::CanFilter> known) {
    hal::CanFrame frame;
    const std::uint8_t choice = bytes.u8();
    frame.id = choice < known.size() ? known[choice].id : bytes.u32();
    const std::uint8_t shape = bytes.u8();
    frame.length = shape & 0x0FU;  // 9 to 15: no frame of a bus, but a driver may be wrong
    frame.extended = (shape & 0x10U) != 0;
    frame.remote = (shape & 0x20U) != 0;
    const bool is_of_map = (shape & 0x40U) != 0;
    for (std::size_t k = 0; k < frame.length && k < frame.data.size(); ++k) {
        frame.data[k] = bytes.u8();
    }
    return is_of_map ? way_frame(frame) : frame;
}

/// Mostly less than a SYNC period, up to 5 ms; once a leap, as of a clock that is set. It costs a thousand ticks: a
/// second one would teach little.
std::uint64_t next_time(fuzz::Bytes& bytes, std::uint64_t now_us, bool& has_leapt) {
    const std::uint8_t step = bytes.u8();
    const bool leaps = step == 255 && !has_leapt;
    has_leapt = has_leapt || leaps;
    if (leaps) {
        return now_us + bytes.u32();
    }
    return now_us + (step < 250 ? 2U * step : 1000U * (step - 249U));
}

void send_all(firmware::CanController& controller, std::uint64_t now_us, float most) {
    hal::CanFrame sent;
    int count = 0;
    while (controller.take_frame(sent)) {
        fuzz::require(
            sent.length <= hal::largest_can_length && sent.id <= hal::largest_standard_can_id && ++count < 100,
            "what is sent are a few frames of a bus");
        hal::FeedOverride decoded;
        if (override_frame::decode(sent, override_frame::default_id, decoded) == override_frame::FrameError::none) {
            require_bounded(decoded, most + 0.5F * override_frame::ratio_per_bit);
        }
        controller.on_frame(sent, now_us, true);  // its echo
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static Controllers controllers;
    controllers.way = controllers.new_way;
    fuzz::Bytes bytes({data, size});
    firmware::CanController controller = bytes.u8() % 2 == 0 ? controllers.running : controllers.starting;
    std::array<hal::CanFilter, firmware::CanController::filter_capacity> filters;
    const std::span known = std::span(filters).first(controller.filters(filters));
    std::uint64_t now_us = controllers.now_us;
    bool has_leapt = false;
    while (bytes.any_left()) {
        now_us = next_time(bytes, now_us, has_leapt);
        controller.on_frame(next_frame(bytes, known), now_us, false);
        controller.poll(now_us);
        send_all(controller, now_us, controllers.most);
        firmware::finish_work(controller);
    }
    return 0;
}
