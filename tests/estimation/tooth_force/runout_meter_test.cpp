// SPDX-License-Identifier: Apache-2.0
#include "estimation/tooth_force/runout_meter.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

using namespace millforce::estimation;

namespace {

constexpr double turn = 2.0 * std::numbers::pi;
constexpr double speed_rad_s = 350.0;
constexpr float per_Nm = 1000.0F / 6.0F;
constexpr float stated_mm = 0.006F;

/// A cut by teeth on a circle whose axis lies off the spindle's, summed over the angle. Edge forces are in it.
struct Milling {
    int teeth = 4;
    double radial_immersion = 2.0;
    CutSide side = CutSide::down;
    double feed_per_tooth_mm = 0.05;
    double off_axis_mm = 0.005;
    double off_axis_rad = 0.7;
    double feed_direction_rad = 0.0;
    double chip_N_per_mm = 10000.0;
    double edge_N = 90.0;

    [[nodiscard]] double excess_mm(int tooth) const {
        const auto radius_mm = [this](int k) { return off_axis_mm * std::cos(off_axis_rad - turn * k / teeth); };
        return radius_mm(tooth) - radius_mm(tooth - 1);
    }
    [[nodiscard]] double largest_excess_mm() const {
        double largest_mm = 0.0;
        for (int k = 0; k < teeth; ++k) {
            largest_mm = std::max(largest_mm, excess_mm(k));
        }
        return largest_mm;
    }
    /// F_t of all teeth; of the chips alone without `with_edge`.
    [[nodiscard]] double tangential_N(double spindle_rad, bool with_edge = true) const {
        const double arc_rad = std::acos(1.0 - radial_immersion);
        const double begin_rad = side == CutSide::down ? std::numbers::pi - arc_rad : 0.0;
        double sum_N = 0.0;
        for (int k = 0; k < teeth; ++k) {
            double phi = spindle_rad + feed_direction_rad - turn * k / teeth;
            phi -= turn * std::floor(phi / turn);
            if (phi >= begin_rad && phi < begin_rad + arc_rad) {
                const double chip_mm = std::max(0.0, feed_per_tooth_mm * std::sin(phi) + excess_mm(k));
                sum_N += chip_N_per_mm * chip_mm + (with_edge && chip_mm > 0.0 ? edge_N : 0.0);
            }
        }
        return sum_N;
    }
    [[nodiscard]] double mean_N(double middle_rad, double half_width_rad, bool with_edge = true) const {
        constexpr int steps = 40;
        double sum_N = 0.0;
        for (int i = 0; i < steps; ++i) {
            const double angle_rad = middle_rad + half_width_rad * (2.0 * (i + 0.5) / steps - 1.0);
            sum_N += tangential_N(angle_rad, with_edge) / steps;
        }
        return sum_N;
    }
};

/// The spindle of a rotor that carries `rotor_share` of what turns, with noise on the current.
struct Spindle {
    double rotor_share = 0.5;
    double noise_A = 0.0;
    double air_A = 0.0;  // what the drive shows by itself, once per revolution
    std::mt19937_64 random{7};

    SpindleDriveParameters<float> parameters() const {
        SpindleDriveParameters<float> p;
        p.K_t1_Nm_per_A = 0.7F;
        p.inertia_kg_m2 = 0.004F;
        p.current_sd_A = static_cast<float>(noise_A);
        return p;
    }

    /// One revolution.
    TurningForce<float> turn_once(const Milling* cut) {
        constexpr int samples = 36;
        std::complex<double> force_N;
        for (int k = 0; cut != nullptr && k < samples; ++k) {
            const double angle_rad = turn * (k + 0.5) / samples;
            force_N += 2.0 / samples * std::polar(cut->mean_N(angle_rad, 0.5 * turn / samples), -angle_rad);
        }
        // J dω/dt = −T, and the time's phasor is −ω_1/ω.
        const std::complex<double> i{0.0, 1.0};
        const std::complex<double> time =
            force_N * rotor_share / (i * static_cast<double>(per_Nm) * 0.004 * speed_rad_s * speed_rad_s);
        std::normal_distribution<double> noise(0.0, noise_A * std::sqrt(2.0 / samples));
        const std::complex<double> current_A = force_N * (1.0 - rotor_share) / (0.7 * static_cast<double>(per_Nm)) +
                                               std::polar(air_A, -1.0) +
                                               std::complex<double>(noise(random), noise(random));
        RevolutionHarmonic<float>::Mean seen;
        seen.revolutions = 1;
        seen.current_A = {static_cast<float>(current_A.real()), static_cast<float>(current_A.imag())};
        seen.time = {static_cast<float>(time.real()), static_cast<float>(time.imag())};
        seen.samples = samples;
        return SpindleDrive<float>(parameters()).turning_force_N(seen, static_cast<float>(speed_rad_s), per_Nm);
    }
};

EngagementEstimate<float> known_arc(const Milling& cut) {
    EngagementEstimate<float> arc;
    arc.immersion_valid = true;
    arc.radial_immersion = static_cast<float>(cut.radial_immersion);
    arc.side = cut.side;
    return arc;
}

double mean_cutting_N(const Milling& cut) {
    constexpr int parts = 36;
    double sum_N = 0.0;
    for (int k = 0; k < parts; ++k) {
        sum_N += cut.mean_N(turn * k / parts, 0.5 * turn / parts, false) / parts;
    }
    return sum_N;
}

void mill(RunoutMeter<float>& meter, Spindle& spindle, const Milling& cut, int revolutions) {
    const auto direction = static_cast<float>(cut.feed_direction_rad);
    const auto cutting_N = static_cast<float>(mean_cutting_N(cut));
    for (int r = 0; r < revolutions; ++r) {
        meter.learn({.turning = spindle.turn_once(&cut),
                     .feed_direction = {std::cos(direction), std::sin(direction)},
                     .feed_per_tooth_mm = static_cast<float>(cut.feed_per_tooth_mm),
                     .cutting_N = cutting_N,
                     .engagement = known_arc(cut)});
    }
}

void mill_by_spindle_alone(RunoutMeter<float>& meter, Spindle& spindle, const Milling& cut, int revolutions) {
    const auto cutting_N = static_cast<float>(mean_cutting_N(cut));
    for (int r = 0; r < revolutions; ++r) {
        meter.learn({.turning = spindle.turn_once(&cut),
                     .feed_per_tooth_mm = static_cast<float>(cut.feed_per_tooth_mm),
                     .cutting_N = cutting_N});
    }
}

void turn_in_air(RunoutMeter<float>& meter, Spindle& spindle, int revolutions = 100) {
    for (int r = 0; r < revolutions; ++r) {
        meter.learn_air(spindle.turn_once(nullptr));
    }
}

double excess_um(const RunoutMeter<float>& meter) {
    return 1000.0 * static_cast<double>(meter.largest_excess_mm());
}

/// Of all places in which a cutter may be clamped; two teeth show in which it is.
double mean_largest_excess_um(Milling cut) {
    if (cut.teeth == 2) {
        return 1000.0 * cut.largest_excess_mm();
    }
    double sum_um = 0.0;
    constexpr int places = 90;
    for (int i = 0; i < places; ++i) {
        cut.off_axis_rad = turn * i / places;
        sum_um += 1000.0 * cut.largest_excess_mm() / places;
    }
    return sum_um;
}

}  // namespace

TEST_GROUP(RunoutMeter){};

TEST(RunoutMeter, finds_how_far_a_tooth_stands_out_in_any_cut) {
    for (const int teeth : {2, 3, 4, 6}) {
        for (const double immersion : {0.5, 1.0, 1.6, 2.0}) {
            for (const CutSide side : {CutSide::down, CutSide::up}) {
                for (const double direction_rad : {0.0, 1.1, -2.4}) {
                    Milling cut{.teeth = teeth, .radial_immersion = immersion, .side = side};
                    cut.feed_direction_rad = direction_rad;
                    Spindle spindle;
                    RunoutMeter<float> meter(stated_mm, teeth);
                    turn_in_air(meter, spindle);
                    mill(meter, spindle, cut, 50);
                    const double expected_um = mean_largest_excess_um(cut);
                    CHECK_COMPARE(excess_um(meter), >, expected_um);
                    CHECK_COMPARE(excess_um(meter), <, 1.25 * expected_um);
                }
            }
        }
    }
}

TEST(RunoutMeter, one_phasor_stands_for_all_cuts_of_a_tool) {
    // Cuts in turn, each too short for its noise: only what stands still in the tool is left.
    Spindle spindle{.noise_A = 3.0};
    Milling cut;
    RunoutMeter<float> meter(stated_mm, cut.teeth);
    turn_in_air(meter, spindle, 500);
    for (int i = 0; i < 100; ++i) {
        cut.feed_direction_rad = 0.7 * i;
        cut.side = i % 2 == 0 ? CutSide::down : CutSide::up;
        cut.radial_immersion = 0.4 + 0.4 * (i % 4);
        mill(meter, spindle, cut, 5);
    }
    const double expected_um = mean_largest_excess_um(cut);
    DOUBLES_EQUAL(1.15 * expected_um, excess_um(meter), 0.2 * expected_um);
}

TEST(RunoutMeter, it_does_not_matter_whether_the_motor_or_the_rotor_carries_it) {
    const Milling cut;
    double by_share[3] = {};
    for (int i = 0; i < 3; ++i) {
        Spindle spindle{.rotor_share = 0.5 * i};
        RunoutMeter<float> meter(stated_mm, cut.teeth);
        turn_in_air(meter, spindle);
        mill(meter, spindle, cut, 50);
        by_share[i] = excess_um(meter);
    }
    DOUBLES_EQUAL(by_share[0], by_share[1], 0.02 * by_share[0]);
    DOUBLES_EQUAL(by_share[0], by_share[2], 0.02 * by_share[0]);
}

TEST(RunoutMeter, what_drive_and_encoder_show_in_air_is_no_runout) {
    Milling cut{.off_axis_mm = 0.0};
    Spindle spindle{.air_A = 1.5};
    RunoutMeter<float> meter(stated_mm, cut.teeth);
    turn_in_air(meter, spindle);
    mill(meter, spindle, cut, 50);
    DOUBLES_EQUAL(3.0, excess_um(meter), 1e-3);
}

TEST(RunoutMeter, without_air_at_this_speed_or_an_arc_it_says_what_the_file_says) {
    const Milling cut;
    Spindle spindle;
    RunoutMeter<float> no_air(stated_mm, cut.teeth);
    mill(no_air, spindle, cut, 50);
    DOUBLES_EQUAL(6.0, excess_um(no_air), 1e-3);

    RunoutMeter<float> no_arc(stated_mm, cut.teeth);
    turn_in_air(no_arc, spindle);
    EngagementEstimate<float> unknown = known_arc(cut);
    unknown.immersion_valid = false;
    no_arc.learn({.turning = spindle.turn_once(&cut),
                  .feed_direction = {1.0F, 0.0F},
                  .feed_per_tooth_mm = 0.05F,
                  .cutting_N = 600.0F,
                  .engagement = unknown});
    DOUBLES_EQUAL(6.0, excess_um(no_arc), 1e-3);
}

TEST(RunoutMeter, a_cut_of_no_whole_revolution_teaches_nothing) {
    const Milling cut;
    Spindle spindle;
    RunoutMeter<float> meter(stated_mm, cut.teeth);
    turn_in_air(meter, spindle);
    TurningForce<float> turning = spindle.turn_once(&cut);
    turning.revolutions = 0;
    meter.learn({.turning = turning,
                 .feed_direction = {1.0F, 0.0F},
                 .feed_per_tooth_mm = 0.05F,
                 .cutting_N = 600.0F,
                 .engagement = known_arc(cut)});
    DOUBLES_EQUAL(6.0, excess_um(meter), 1e-3);
}

TEST(RunoutMeter, by_the_spindle_alone_it_finds_what_the_thickest_chip_has_of_it) {
    for (const double immersion : {0.3, 1.0, 2.0}) {
        for (const double direction_rad : {0.0, 1.1, -2.4}) {
            Milling cut{.radial_immersion = immersion};
            cut.feed_direction_rad = direction_rad;
            Spindle spindle;
            RunoutMeter<float> meter(stated_mm, cut.teeth, true);
            turn_in_air(meter, spindle);
            mill_by_spindle_alone(meter, spindle, cut, 50);
            const double of_chip_um = mean_largest_excess_um(cut) / std::sqrt(0.5 * immersion);
            CHECK_COMPARE(excess_um(meter), >, 0.95 * of_chip_um);
            CHECK_COMPARE(excess_um(meter), <, 1.3 * of_chip_um);
        }
    }
}

TEST(RunoutMeter, half_of_what_the_file_says_always_stays) {
    const Milling cut{.off_axis_mm = 0.0};
    Spindle spindle;
    RunoutMeter<float> meter(stated_mm, cut.teeth);
    turn_in_air(meter, spindle);
    mill(meter, spindle, cut, 500);
    DOUBLES_EQUAL(3.0, excess_um(meter), 1e-3);
}

TEST(RunoutMeter, where_the_file_says_none_it_measures_none) {
    const Milling cut;
    Spindle spindle{.noise_A = 0.1};
    RunoutMeter<float> meter(0.0F, cut.teeth);
    turn_in_air(meter, spindle);
    mill(meter, spindle, cut, 500);
    CHECK_COMPARE(mean_largest_excess_um(cut), >, 4.0);
    CHECK_COMPARE(excess_um(meter), <, 0.1);  // the noise in air
}

TEST(RunoutMeter, keeps_how_much_it_was_when_the_angle_is_lost_and_finds_it_again) {
    Milling cut;
    Spindle spindle;
    RunoutMeter<float> meter(stated_mm, cut.teeth);
    turn_in_air(meter, spindle);
    mill(meter, spindle, cut, 50);
    const double before_um = excess_um(meter);
    meter.lose_angle();
    DOUBLES_EQUAL(before_um, excess_um(meter), 0.01);
    mill(meter, spindle, cut, 50);
    DOUBLES_EQUAL(before_um, excess_um(meter), 0.01);  // no air since then
    cut.off_axis_rad += 2.0;
    turn_in_air(meter, spindle);
    mill(meter, spindle, cut, 50);
    DOUBLES_EQUAL(before_um, excess_um(meter), 0.1 * before_um);
}
