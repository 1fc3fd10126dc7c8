// SPDX-License-Identifier: Apache-2.0
#include "firmware/force_drop_bench.hpp"
#include "firmware/wide_band_monitor.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <initializer_list>

namespace hal = millforce::hal;
namespace estimation = millforce::estimation;
using Monitor = millforce::firmware::WideBandMonitor<float>;
using Parameters = millforce::firmware::Parameters<float>;
using namespace millforce::test::force_drop;

namespace {

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
