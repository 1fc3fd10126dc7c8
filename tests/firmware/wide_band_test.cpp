// SPDX-License-Identifier: Apache-2.0
#include "firmware/wide_band_monitor.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <initializer_list>
#include <numbers>

namespace hal = millforce::hal;
namespace estimation = millforce::estimation;
using Monitor = millforce::firmware::WideBandMonitor<float>;
using Parameters = millforce::firmware::Parameters<float>;

namespace {

constexpr double speed_rev_s = 5.0;
constexpr double rate_hz = 2560.0;
constexpr double feed_per_tooth_mm = 0.15;
constexpr int teeth = 3;
constexpr float feed_mm_s = static_cast<float>(feed_per_tooth_mm * teeth * speed_rev_s);

/// A law without edges and size effect: K the same everywhere, r = r_av = 0.4.
Parameters parameters() {
    Parameters p;
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

    hal::DriveSample next() {
        const double turned_rev = index_ * speed_rev_s / rate_hz;
        double x = 0.0;
        double y = 0.0;
        for (int tooth = 0; tooth < teeth; ++tooth) {
            const double phi = 2.0 * std::numbers::pi * std::fmod(turned_rev + static_cast<double>(tooth) / teeth, 1.0);
            if (phi < exit_rad_) {
                const double F_t = 3000.0 * feed_per_tooth_mm * std::sin(phi);
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

  private:
    double exit_rad_;
    LowPass x_;
    LowPass y_;
    int index_ = 0;
};

void mill(Monitor& monitor, Cut& cut, double revolutions, bool in_cut = true) {
    const int samples = static_cast<int>(revolutions * rate_hz / speed_rev_s);
    for (int k = 0; k < samples; ++k) {
        monitor.add(static_cast<float>(1.0 / rate_hz), cut.next(), in_cut);
        if (monitor.work_due()) {
            monitor.work();
        }
    }
}

}  // namespace

TEST_GROUP(WideBandMonitor){};

TEST(WideBandMonitor, tells_the_immersion_from_force_drops) {
    for (const double immersion : {0.3, 0.5, 0.7}) {
        Monitor monitor(parameters());
        Cut cut(immersion);
        mill(monitor, cut, 12.0);
        const auto& told = monitor.estimate().force_drop_immersion;
        CHECK(told.valid);
        DOUBLES_EQUAL(immersion, static_cast<double>(told.value), 0.04 * immersion);
        UNSIGNED_LONGS_EQUAL(2, monitor.estimate().force_drops);
    }
}

TEST(WideBandMonitor, does_its_work_only_when_it_is_called) {
    Monitor monitor(parameters());
    Cut cut(0.5);
    for (int k = 0; k < static_cast<int>(20.0 * rate_hz / speed_rev_s); ++k) {
        monitor.add(static_cast<float>(1.0 / rate_hz), cut.next(), true);
    }
    CHECK(monitor.work_due());
    CHECK_FALSE(monitor.estimate().force_drop_immersion.valid);
    monitor.work();
    CHECK_FALSE(monitor.work_due());
    CHECK(monitor.estimate().force_drop_immersion.valid);
}

TEST(WideBandMonitor, has_no_estimate_once_the_cut_ends_or_samples_stay_away) {
    Monitor monitor(parameters());
    Cut cut(0.5);
    mill(monitor, cut, 10.0);
    CHECK(monitor.estimate().force_drop_immersion.valid);
    mill(monitor, cut, 0.1, false);
    CHECK_FALSE(monitor.estimate().force_drop_immersion.valid);
    mill(monitor, cut, 10.0);
    CHECK(monitor.estimate().force_drop_immersion.valid);
    hal::DriveSample gone = cut.next();
    gone.present = hal::mask(hal::Present::spindle_count);
    monitor.add(static_cast<float>(1.0 / rate_hz), gone, true);
    CHECK_FALSE(monitor.estimate().force_drop_immersion.valid);
}

TEST(WideBandMonitor, takes_nothing_that_is_no_number) {
    Monitor monitor(parameters());
    Cut cut(0.5);
    mill(monitor, cut, 10.0);
    for (const int broken : {0, 1, 2}) {
        hal::DriveSample sample = cut.next();
        float& value =
            broken == 0 ? sample.force_N[1] : sample.axis_velocity_mm_s[static_cast<std::size_t>(broken - 1)];
        value = std::nanf("");
        monitor.add(static_cast<float>(1.0 / rate_hz), sample, true);
        CHECK_FALSE(monitor.estimate().force_drop_immersion.valid);
    }
    mill(monitor, cut, 10.0);
    DOUBLES_EQUAL(0.5, static_cast<double>(monitor.estimate().force_drop_immersion.value), 0.02);
}

TEST(WideBandMonitor, does_nothing_where_the_tool_has_no_law) {
    Parameters p = parameters();
    p.tool.force_drop.law.largest_immersion = 0.0F;
    Monitor monitor(p);
    CHECK_FALSE(monitor.uses_force_drop());
    Cut cut(0.5);
    mill(monitor, cut, 10.0);
    UNSIGNED_LONGS_EQUAL(0, monitor.estimate().force_drops);
}
