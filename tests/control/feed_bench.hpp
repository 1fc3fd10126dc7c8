// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/feed_controller.hpp"
#include "estimation/number/circle.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

/// A cut as the controller sees it, and numbers that are the same on every machine.

namespace millforce::control::bench {

using Input = ControlInput<float>;
using Output = ControlOutput<float>;

inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
inline constexpr float beyond_all = std::numeric_limits<float>::infinity();

/// The defaults, and a tool and a CNC: what the firmware's controller_parameters() adds; for a part of one depth.
struct Parameters : FeedControllerParameters<float> {
    Parameters() {
        tooth_force_limit_N = 1000.0F;
        setpoint_share = 0.97F;
        teeth = 4.0F;
        override_min = 0.1F;
        override_max = 1.5F;
        stale_s = 0.05F;
        depth_step_ratio = 1.0F;
    }
};

struct Controller : FeedController<float> {
    explicit Controller(const bench::Parameters& parameters = {}) : FeedController(parameters) {}
};

/// 400 rad/s with 4 teeth: 254.6 teeth per second, so that 20 mm/s is 0.0785 mm per tooth.
inline Input in_contact() {
    Input input;
    input.programmed_feed_mm_s = 20.0F;
    input.path_speed_mm_s = 20.0F;
    input.cut.fresh = true;
    input.cut.force_valid = true;
    input.cut.tangential_N = 200.0F;
    input.cut.tangential_sd_N = 5.0F;
    input.cut.tooth_force_valid = true;
    input.cut.tooth_force_N = 500.0F;
    input.cut.feed_mm_s = 20.0F;
    input.cut.spindle_speed_rad_s = 400.0F;
    input.cut.spindle_turning = true;
    return input;
}

inline Input in_air() {
    Input input = in_contact();
    input.cut.tangential_N = 0.0F;
    input.cut.tooth_force_N = 0.0F;
    return input;
}

inline Input without_force(Input input) {
    input.cut.force_valid = false;
    input.cut.tooth_force_valid = false;
    return input;
}

/// What a tooth would carry at that override, in newtons: F = F₀ (f/f₀)^(1+p_s).
inline float force_at(float override_ratio, const Input& input) {
    const float feed_ratio = override_ratio * input.programmed_feed_mm_s / input.cut.feed_mm_s;
    return input.cut.tooth_force_N * std::pow(feed_ratio, input.cut.feed_exponent);
}

inline float ratio_of(float feed_per_tooth_mm, const Input& input, float teeth = 4.0F) {
    return feed_per_tooth_mm * teeth * input.cut.spindle_speed_rad_s / estimation::turn_rad<float> /
           input.programmed_feed_mm_s;
}

/// In cut after two steps, and the law's demand is taken at once.
inline Parameters immediate() {
    Parameters p;
    p.override_min = 0.001F;
    p.override_max = 9.9F;
    p.recovery_per_rev = 1e6F;
    p.slew_up_per_s = 1e6F;
    p.slew_down_per_s = 1e6F;
    p.max_feed_per_tooth_mm = 100.0F;
    p.entry_revolutions = 0.0F;
    p.entry_travel_mm = 0.0F;
    return p;
}

inline Output repeat(Controller& controller, const Input& input, int steps) {
    Output output;
    for (int k = 0; k < steps; ++k) {
        output = controller.step(input);
    }
    return output;
}

/// Contact until the state is `in_cut`: 5 mm at 20 mm/s with the default parameters.
inline Output bring_into_cut(Controller& controller, const Input& input = in_contact()) {
    Output output;
    for (int k = 0; k < 1000 && controller.state() != CutState::in_cut; ++k) {
        output = controller.step(input);
    }
    return output;
}

/// The standard's engine is the same everywhere, its distributions are not.
class Dice {
  public:
    explicit Dice(std::uint32_t seed) : engine_(seed) {}
    std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(engine_() % bound); }
    bool one_in(std::uint32_t n) { return below(n) == 0; }
    float between(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_() & 0xFFFFFFU) / 16777215.0F;
    }
    /// What a broken sensor or a bug upstream may hand over; now and then something sensible.
    float anything() {
        using limits = std::numeric_limits<float>;
        const float extremes[] = {
            not_a_number, beyond_all,    -beyond_all,      0.0F,          -0.0F, -1.0F,
            1e-3F,        limits::max(), limits::lowest(), limits::min(), 1.0F,  limits::denorm_min()};
        if (one_in(3)) {
            return extremes[below(12)];
        }
        const float magnitude = std::exp(between(-20.0F, 20.0F));
        return one_in(4) ? -magnitude : magnitude;
    }

  private:
    std::mt19937 engine_;
};

}  // namespace millforce::control::bench
