// SPDX-License-Identifier: Apache-2.0
#include "firmware/force_drop_bench.hpp"
#include "firmware/tick.hpp"

#include <CppUTest/TestHarness.h>

#include <cstdint>

using namespace millforce;
using namespace millforce::test::force_drop;
using control::CutState;
using firmware::step_and_work;
using Tick = firmware::ForceControlTick<float>;

namespace {

constexpr double immersion = 0.5;

/// Besides its force sensor it has the spindle's current, which alone does not determine the cut's width.
firmware::Parameters<float> face_mill() {
    firmware::Parameters<float> p = parameters();
    p.machine.spindle.K_t1_Nm_per_A = 0.7F;
    p.machine.spindle.K_t2_Nm = -0.95F;
    p.machine.spindle.inertia_kg_m2 = 0.004F;
    p.tool.tooth_force_limit_N = 3000.0F;
    p.tool.law = estimation::linear_edge_law(1500.0F, 0.0F, 600.0F, 0.0F);
    p.tool.control.entry_travel_mm = 0.0F;
    return p;
}

/// Depths, which say nothing of the force drops, are found several times between two of these.
firmware::Parameters<float> face_mill_that_shows_depths() {
    firmware::Parameters<float> p = face_mill();
    p.tool.force_drop.revolutions = 12;
    p.tool.helix_deg = 10.0F;
    p.tool.depth_shape.nominal_axial_depth_mm = 2.0F;
    p.tool.depth_shape.nominal_radial_width_mm = 25.0F;
    p.tool.depth_shape.feed_per_tooth_mm = static_cast<float>(feed_per_tooth_mm);
    p.tool.depth_shape.revolutions = 2;
    return p;
}

hal::ProgramStatus program() {
    hal::ProgramStatus status;
    status.programmed_feed_mm_s = feed_mm_s;
    return status;
}

class Milling {
  public:
    explicit Milling(const firmware::Parameters<float>& parameters) : tick_(parameters), p_(parameters) {}

    Milling& mill(double revolutions, double depth = 1.0) {
        const int samples = static_cast<int>(revolutions * rate_hz / speed_rev_s);
        for (int k = 0; k < samples; ++k) {
            step_and_work(tick_, sample_at(depth), program());
        }
        return *this;
    }
    Milling& fly(double revolutions) { return mill(revolutions, 0.0); }
    /// Into the cut, until it has been looked at once.
    Milling& mill_until_the_drops_are_known() {
        for (int k = 0; k < 15 && tick_.wide_band().force_drops == 0; ++k) {
            mill(1);
        }
        return *this;
    }

    [[nodiscard]] const Tick& tick() const { return tick_; }
    [[nodiscard]] const estimation::EngagementEstimate<float>& engagement() const {
        return tick_.estimate().engagement;
    }

    bool has_spindle_current = true;

  private:
    hal::DriveSample sample_at(double depth) {
        constexpr float m_per_mm = 0.001F;
        const auto& spindle = p_.machine.spindle;
        const float radius_m = 0.5F * p_.tool.diameter_mm * m_per_mm;
        const float torque_Nm = static_cast<float>(depth * cut_.tangential_N()) * radius_m;
        hal::DriveSample sample = cut_.next(depth);
        sample.present = static_cast<std::uint8_t>(sample.present | hal::all_present);
        sample.spindle_current_A = (torque_Nm - spindle.K_t2_Nm) / spindle.K_t1_Nm_per_A;
        if (!has_spindle_current) {
            sample.present = static_cast<std::uint8_t>(sample.present & ~hal::mask(hal::Present::spindle_current));
        }
        return sample;
    }

    Tick tick_;
    firmware::Parameters<float> p_;
    Cut cut_{immersion};
};

}  // namespace

TEST_GROUP(TickWithForceDrops){};

TEST(TickWithForceDrops, knows_the_width_that_the_spindle_alone_does_not_determine) {
    firmware::Parameters<float> without_law = face_mill();
    without_law.tool.force_drop.law.largest_immersion = 0.0F;
    Milling without(without_law);
    without.fly(2).mill(14);
    CHECK(without.tick().control().state == CutState::in_cut);
    CHECK_FALSE(without.engagement().immersion_valid);
    Milling milling(face_mill());
    milling.fly(2).mill(14);
    CHECK(milling.tick().control().state == CutState::in_cut);
    CHECK(milling.engagement().immersion_valid);
    DOUBLES_EQUAL(immersion, static_cast<double>(milling.engagement().radial_immersion), 0.04 * immersion);
}

TEST(TickWithForceDrops, holds_no_air_before_the_cut_for_a_section_that_the_drops_belong_to) {
    Milling milling(face_mill());
    milling.fly(6).mill_until_the_drops_are_known().mill(1);
    UNSIGNED_LONGS_EQUAL(1, milling.tick().wide_band().force_drops);
    CHECK(milling.engagement().immersion_valid);
    DOUBLES_EQUAL(immersion, static_cast<double>(milling.engagement().radial_immersion), 0.04 * immersion);
}

TEST(TickWithForceDrops, looks_at_no_air_unless_nothing_distinguishes_it_from_a_cut) {
    Milling milling(face_mill());
    milling.fly(10);
    UNSIGNED_LONGS_EQUAL(0, milling.tick().wide_band().force_drops);
    Milling by_sensor_alone(face_mill());
    by_sensor_alone.has_spindle_current = false;
    by_sensor_alone.mill(6);
    CHECK(by_sensor_alone.tick().wide_band().force_drop_immersion.valid);
}

TEST(TickWithForceDrops, leaves_open_whether_a_cut_that_grows_becomes_wider_or_deeper_until_the_next_drops) {
    Milling milling(face_mill_that_shows_depths());
    milling.fly(2).mill_until_the_drops_are_known().mill(1);
    const float before_sd = milling.engagement().radial_immersion_sd;
    const auto depths_before = milling.tick().wide_band().depths;
    milling.mill(4, 1.2);
    UNSIGNED_LONGS_EQUAL(1, milling.tick().wide_band().force_drops);
    CHECK(milling.tick().wide_band().depths > depths_before);
    CHECK(milling.engagement().radial_immersion_sd > 2.0F * before_sd);
    milling.mill(8, 1.2);
    UNSIGNED_LONGS_EQUAL(2, milling.tick().wide_band().force_drops);
    CHECK(milling.engagement().radial_immersion_sd < 2.0F * before_sd);
}
