// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "firmware/parameters.hpp"
#include "hal/drive_sample.hpp"

/// A face mill with a force sensor, for tests of the force drops: 3 teeth at 300 rpm.

namespace millforce::test::force_drop {

inline constexpr double speed_rev_s = 5.0;
inline constexpr double rate_hz = 2560.0;
inline constexpr double feed_per_tooth_mm = 0.15;
inline constexpr int teeth = 3;
inline constexpr float feed_mm_s = static_cast<float>(feed_per_tooth_mm * teeth * speed_rev_s);

/// A law without edges and size effect: K the same everywhere, r = r_av = 0.4.
inline firmware::Parameters<float> parameters() {
    firmware::Parameters<float> p;
    p.machine.encoder_counts_per_rev = 8192;
    p.tool.teeth = teeth;
    p.tool.diameter_mm = 100.0F;
    p.tool.side = estimation::CutSide::up;
    p.tool.force_sensor.low_pass_hz = 300.0F;
    auto& law = p.tool.force_drop.law;
    law.a = 0.0F;
    law.b = 0.4F;
    law.r_scatter = 0.01F;
    law.ln_K_scatter = 0.01F;
    law.smallest_immersion = 0.1F;
    law.largest_immersion = 0.9F;
    return p;
}

/// Two poles at 300 Hz, Butterworth.
class LowPass {
  public:
    double step(double in) {
        for (int k = 0; k < 8; ++k) {
            const double w = 2.0 * std::numbers::pi * 300.0;
            const double h = 1.0 / (8.0 * rate_hz);
            rate_ += h * (w * w * (in - out_) - std::numbers::sqrt2 * w * rate_);
            out_ += h * rate_;
        }
        return out_;
    }

  private:
    double out_ = 0.0;
    double rate_ = 0.0;
};

/// Up milling of one immersion along +x, chip f_z sin φ, K a = 3000 N/mm.
class Cut {
  public:
    explicit Cut(double immersion) : exit_rad_(std::acos(1.0 - immersion)) {}

    /// `load`: of the depth; 0: air.
    hal::DriveSample next(double load = 1.0) {
        const double turned_rev = index_ * speed_rev_s / rate_hz;
        double x = 0.0;
        double y = 0.0;
        for (int tooth = 0; tooth < teeth; ++tooth) {
            const double phi = 2.0 * std::numbers::pi * std::fmod(turned_rev + static_cast<double>(tooth) / teeth, 1.0);
            if (phi < exit_rad_) {
                const double F_t = load * 3000.0 * feed_per_tooth_mm * std::sin(phi);
                x += F_t * (std::cos(phi) + 0.4 * std::sin(phi));
                y += F_t * (-std::sin(phi) + 0.4 * std::cos(phi));
            }
        }
        hal::DriveSample sample;
        sample.time_us = static_cast<std::uint32_t>(std::llround(index_ * 1e6 / rate_hz));
        sample.spindle_count = static_cast<std::uint32_t>(turned_rev * 8192.0);
        sample.spindle_index_number = 1;
        sample.present = hal::mask(hal::Present::spindle_count) | hal::mask(hal::Present::force_sensor);
        sample.axis_velocity_mm_s = {feed_mm_s, 0.0F, 0.0F};
        sample.force_N = {static_cast<float>(x_.step(x)), static_cast<float>(y_.step(y))};
        ++index_;
        return sample;
    }
    /// Mean F_at of its teeth.
    [[nodiscard]] double tangential_N() const {
        return teeth * 3000.0 * feed_per_tooth_mm * (1.0 - std::cos(exit_rad_)) / (2.0 * std::numbers::pi);
    }

  private:
    double exit_rad_;
    LowPass x_;
    LowPass y_;
    int index_ = 0;
};

}  // namespace millforce::test::force_drop
