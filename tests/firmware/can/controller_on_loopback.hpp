// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bus/cnc_on_bus.hpp"
#include "bus/loopback_bus.hpp"
#include "bus/machine_on_bus.hpp"
#include "bus/plant_wiring.hpp"
#include "firmware_can/can_controller.hpp"
#include "loop/override_source.hpp"
#include "loop/scenario.hpp"
#include "parameters/machine_bus.hpp"
#include "parameters/parameter_files.hpp"

/// The whole controller, a machine's drives and a CNC on one bus in memory, in virtual time.

namespace millforce::test {

/// The n-th millisecond of a spindle that turns at 4000 rpm without a cut; the axes rest.
inline hal::DriveSample turning_in_air(std::uint32_t n) {
    hal::DriveSample sample;
    sample.present = hal::all_present;
    sample.time_us = 1000U * n;
    sample.spindle_count = 546U * n;
    sample.spindle_current_A = 2.0F;
    return sample;
}

struct LoggedFrame {
    std::uint64_t time_us = 0;
    hal::CanFrame frame{};
    bool is_own = false;
};

/// One line per tick: everything that it estimated and commanded, with all digits.
class TickLog final : public firmware::TickListener {
  public:
    void on_tick(const firmware::CanController& controller) override {
        if (!is_kept) {
            return;
        }
        const firmware::TickRecord tick = controller.record();
        std::string line = std::to_string(tick.time_us);
        for (const float value : {tick.tangential_force_N, tick.feed_force_N, tick.radial_immersion,
                                  tick.axial_depth_mm, tick.total_force.tooth_force_N, tick.feed_override.ratio}) {
            line += ',' + host::CsvWriter::cell(value);
        }
        lines.push_back(line + ',' + std::to_string(tick.feed_override.state));
    }
    std::vector<std::string> lines{};
    bool is_kept = true;
};

inline firmware::CanControllerSettings controller_settings(const host::MachineBus& bus) {
    firmware::CanControllerSettings settings;
    settings.drives = bus.drives;
    settings.produces_sync = bus.produces_sync;
    settings.feed_override = bus.feed_override;
    settings.program = bus.program;
    return settings;
}

inline sim::CncOnBusSettings cnc_settings(const sim::Scenario& scenario, const host::MachineBus& bus,
                                          bool reports_position) {
    sim::CncOnBusSettings settings = sim::cnc_on_bus(scenario, bus);
    settings.reports_position = reports_position;
    return settings;
}

/// An override source whose controller sits behind the bus. Each step is one SYNC period.
class ControllerOnLoopback : public sim::OverrideSource {
  public:
    /// With `way` the CNC reports its position, too.
    explicit ControllerOnLoopback(const sim::Scenario& scenario, const firmware::ToolSource* tools = nullptr,
                                  firmware::WaySource<float>* way = nullptr)
        : ControllerOnLoopback(scenario, host::read_machine_bus(scenario.machine_file).value(), tools, way) {}
    ControllerOnLoopback(const sim::Scenario& scenario, const host::MachineBus& bus,
                         const firmware::ToolSource* tools = nullptr, firmware::WaySource<float>* way = nullptr)
        : machine(sim::drives_on_bus(scenario, bus)),
          cnc(cnc_settings(scenario, bus, way != nullptr)),
          controller(controller_settings(bus), scenario.parameters, &ticks, tools, way) {
        sender_ = wire.attach([](const hal::CanFrame&, std::uint64_t) {});
        wire.attach([this](const hal::CanFrame& frame, std::uint64_t t) { hear(frame, t); });
        plant_ = wire.attach([this](const hal::CanFrame& frame, std::uint64_t t) {
            if (frame.id == 0x080) {
                machine.set(sample_at(t));
            }
            machine.on_frame(frame, t);
            cnc.on_frame(frame, t);
        });
    }

    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override {
        follow_speed(newest_, sample);
        newest_ = sample;
        newest_us_ = now_us;
        machine.set(sample);
        if (cnc_tells_) {
            cnc.set(program, now_us);
        }
        run_us(1000);
        const override_frame::ReceivedOverride got = cnc.feed_override(now_us);
        return {got.ratio, got.hold, got.state, got.fault, 0};
    }
    void describe(sim::TracePoint& point) const override { sim::describe(controller.record(), point); }
    [[nodiscard]] bool is_ready() const override { return cnc.feed_override(now_us).is_alive; }

    void run_us(std::uint64_t duration_us) {
        for (const std::uint64_t end_us = now_us + duration_us; now_us < end_us; now_us += 20) {
            if (controller_runs) {
                controller.poll(now_us);
                hal::CanFrame frame;
                while (controller.take_frame(frame)) {
                    wire.send(sender_, frame, now_us);
                }
            }
            if (beside) {
                beside(now_us);
            }
            machine.poll(now_us);
            cnc.poll(now_us);
            for (const auto& frames : {machine.take_frames(), cnc.take_frames()}) {
                for (const hal::CanFrame& sent : frames) {
                    wire.send(plant_, sent, now_us);
                }
            }
            wire.advance_to(now_us);
        }
    }
    void silence_cnc() { cnc_tells_ = false; }

    sim::LoopbackBus wire{};
    sim::MachineOnBus machine;
    sim::CncOnBus cnc;
    TickLog ticks{};
    firmware::CanController controller;
    std::vector<LoggedFrame> log{};
    std::uint64_t now_us = 1'700'000'000'000'000;
    bool controller_runs = true;
    bool keeps_log = true;  ///< of frames
    /// What others on the bus do, each 20 µs.
    std::function<void(std::uint64_t now_us)> beside{};
    /// How much later than the SYNC its stamp is. Empty: not at all.
    std::function<std::uint64_t()> sync_stamp_late_us{};

  private:
    /// A drive latches its values at the SYNC, which other frames delay, and not when the plant was stepped last.
    /// The spindle between two samples. A count alone is known to one, and so would its step be.
    void follow_speed(const hal::DriveSample& before, const hal::DriveSample& now) {
        constexpr double rounding = 1.5;  // counts
        constexpr double share = 0.0625;
        const auto step_us = static_cast<double>(now.time_us - before.time_us);
        const auto step_counts =
            static_cast<double>(static_cast<std::int32_t>(now.spindle_count - before.spindle_count));
        step_us_ = step_us;
        if (!(step_us > 0.0)) {
            return;
        }
        const double deviation = step_counts - counts_per_us_ * step_us;
        counts_per_us_ += (std::abs(deviation) < rounding ? share : 1.0) * deviation / step_us;
    }
    [[nodiscard]] hal::DriveSample sample_at(std::uint64_t time_us) const {
        hal::DriveSample sample = newest_;
        const auto later_us = static_cast<double>(time_us - newest_us_);
        if (later_us < step_us_) {
            sample.time_us += static_cast<std::uint32_t>(later_us);
            sample.spindle_count += static_cast<std::uint32_t>(std::lround(counts_per_us_ * later_us));
        }
        return sample;
    }
    void hear(const hal::CanFrame& frame, std::uint64_t time_us) {
        const bool is_own = frame.id == 0x080 || frame.id == 0x000 || frame.id == 0x1FE || frame.id == 0x77E ||
                            (frame.id & 0x780U) == 0x600;
        if (frame.id == 0x080 && sync_stamp_late_us) {
            time_us += sync_stamp_late_us();
        }
        if (keeps_log) {
            log.push_back({time_us, frame, is_own});
        }
        if (controller_runs) {
            controller.on_frame(frame, time_us, is_own);
        }
    }

    hal::DriveSample newest_{};
    double step_us_ = 0.0;  // between the newest two
    double counts_per_us_ = 0.0;
    std::uint64_t newest_us_ = 0;
    int sender_ = 0;
    int plant_ = 0;
    bool cnc_tells_ = true;
};

/// What the controller makes of a run's log of frames, with polls between them `late_us` after each frame's time.
inline std::vector<std::string> replayed(const ControllerOnLoopback& run, const sim::Scenario& scenario,
                                         std::uint64_t late_us = 0, const firmware::ToolSource* tools = nullptr) {
    firmware::CanControllerSettings settings =
        controller_settings(host::read_machine_bus(scenario.machine_file).value());
    settings.produces_sync = false;
    TickLog ticks;
    firmware::CanController controller(settings, scenario.parameters, &ticks, tools);
    for (const LoggedFrame& logged : run.log) {
        if (late_us > 0) {
            controller.poll(logged.time_us + late_us);
        }
        const bool is_boot_up = logged.frame.id == 0x77E && logged.frame.data[0] == 0;
        controller.on_frame(logged.frame, logged.time_us, is_boot_up);
        hal::CanFrame sent;
        while (controller.take_frame(sent)) {
        }
    }
    return ticks.lines;
}

}  // namespace millforce::test
