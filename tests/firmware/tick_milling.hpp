// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "firmware/tick_bench.hpp"

/// Milling with a tick through loads that change.

namespace millforce::test {

/// Shares of what the spindle's current and that of the axis have beyond air in the cut of tick_bench.hpp.
struct Load {
    float spindle = 1.0F;
    float axis = 1.0F;
};

inline constexpr Load air{0.0F, 0.0F};
inline constexpr Load whole{1.0F, 1.0F};
inline constexpr Load faded{0.75F, 1.0F};  // the spindle's current has, the axis carries what it did
inline constexpr Load lighter{0.65F, 0.65F};
inline constexpr Load wide{1.0F, 0.4F};  // its forces determine the width, those of `whole` hardly do

inline hal::DriveSample loaded(int index, Load load) {
    hal::DriveSample sample = sample_of(1200 + index);  // 80 revolutions later, in the cut
    const hal::DriveSample idle = sample_of(0);
    sample.time_us = static_cast<std::uint32_t>(index) * 1000U;
    sample.spindle_current_A =
        idle.spindle_current_A + load.spindle * (sample.spindle_current_A - idle.spindle_current_A);
    sample.axis_current_A[0] = idle.axis_current_A[0] + load.axis * (sample.axis_current_A[0] - idle.axis_current_A[0]);
    return sample;
}

/// Nothing but the force on a tooth limits the feed.
inline Parameters with_all_currents() {
    Parameters p = machine_and_tool();
    p.tool.control.depth_step_ratio = 1.0F;
    p.tool.control.surge_radial_immersion = 0.0F;
    return p;
}

inline Parameters without_axes(Parameters p) {
    for (auto& axis : p.machine.axes) {
        axis.K_x4_N_per_A = 0.0F;
    }
    return p;
}

inline Parameters spindle_alone() {
    Parameters p = without_axes(with_all_currents());
    p.machine.spindle_rated_current_A = 20.0F;
    return p;
}

/// Its idle torque is so little known that the forces of the cut leave no engagement, nor a bound of it.
inline Parameters with_unclear_torque() {
    Parameters p = with_all_currents();
    p.machine.spindle.idle_torque_sd_Nm = 0.4F;
    p.tool.control.contact_significance = 0.0F;
    return p;
}

using Tick = firmware::ForceControlTick<float>;

inline const Tick& tick_with_axes() {
    static const Tick tick(with_all_currents());
    return tick;
}

inline const Tick& tick_alone() {
    static const Tick tick(spindle_alone());
    return tick;
}

class Milling {
  public:
    explicit Milling(const Tick& tick = tick_with_axes()) : tick_(tick) {}

    Milling& mill(Load load, int samples = 1500) { return mill_from(load, load, samples); }
    /// The load changes evenly.
    Milling& mill_from(Load from, Load to, int samples) {
        for (int k = 0; k < samples; ++k) {
            const float share = static_cast<float>(k) / static_cast<float>(samples);
            take(loaded(index_, {from.spindle + share * (to.spindle - from.spindle),
                                 from.axis + share * (to.axis - from.axis)}));
        }
        return *this;
    }
    Milling& rest(int samples = 500) { return dwell(air, samples); }
    /// The axes stand, whatever the spindle carries.
    Milling& dwell(Load load, int samples = 500) {
        for (int k = 0; k < samples; ++k) {
            hal::DriveSample sample = loaded(index_, load);
            sample.axis_velocity_mm_s = {};
            sample.axis_current_A = {};
            take(sample);
        }
        return *this;
    }
    /// Over 6 mm, into air that is too short to learn anything.
    Milling& leave_the_cut(Load load) { return mill_from(load, air, 300).mill(air, 200); }
    Milling& enter_the_cut(Load load, int samples = 1500) { return mill_from(air, load, 200).mill(load, samples); }

    [[nodiscard]] float ratio() const { return tick_.control().ratio; }
    /// From now on.
    Milling& watch_highest_ratio() {
        highest_ratio_ = ratio();
        return *this;
    }
    [[nodiscard]] float highest_ratio() const { return highest_ratio_; }
    [[nodiscard]] Tick& tick() { return tick_; }
    [[nodiscard]] control::CutState state() const { return tick_.control().state; }

    hal::ProgramStatus status = program();
    std::uint8_t missing = 0;  ///< signals, as a mask
    bool is_along_y = false;
    bool has_time_to_work = true;  ///< beside the samples

  private:
    void take(hal::DriveSample sample) {
        sample.present = static_cast<std::uint8_t>(sample.present & ~missing);
        if (is_along_y) {
            std::swap(sample.axis_velocity_mm_s[0], sample.axis_velocity_mm_s[1]);
            std::swap(sample.axis_current_A[0], sample.axis_current_A[1]);
        }
        if (has_time_to_work) {
            firmware::step_and_work(tick_, sample, status);
        } else {
            tick_.step(sample, status);
        }
        highest_ratio_ = std::max(highest_ratio_, ratio());
        ++index_;
    }

    Tick tick_;
    int index_ = 0;
    float highest_ratio_ = 0.0F;
};

}  // namespace millforce::test
