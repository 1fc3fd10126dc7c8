// SPDX-License-Identifier: Apache-2.0
#include "estimation/drives/spindle_drive.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>

using namespace millforce::estimation;

namespace {

SpindleDriveParameters<double> paper_spindle() {
    SpindleDriveParameters<double> p;
    p.K_t1_Nm_per_A = 196.61 * 0.004;  // Kim & Chung Eq. 8 at R = 4 mm
    p.K_t2_Nm = -1911.0 * 0.004;
    return p;
}

SpindleDrive<double>::Average at_current(double current_A, double speed_rad_s = 131.9) {
    return {.current_A = current_A, .speed_rad_s = speed_rad_s, .samples = 40.0, .present = true};
}

}  // namespace

TEST_GROUP(SpindleDrive){};

TEST(SpindleDrive, gives_the_papers_force_and_none_at_its_idle_current) {
    const SpindleDrive<double> drive(paper_spindle());
    DOUBLES_EQUAL(196.61 * 15.0 - 1911.0, drive.tangential_force_N(at_current(15.0), 4.0).value, 1e-6);
    DOUBLES_EQUAL(0.0, drive.tangential_force_N(at_current(9.7197), 4.0).value, 0.05);
}

TEST(SpindleDrive, takes_the_rotors_inertia_out) {
    auto p = paper_spindle();
    p.inertia_kg_m2 = 0.01;
    const SpindleDrive<double> drive(p);
    auto braking = at_current(12.0);
    braking.acceleration_rad_s2 = -20.0;  // the rotor gives 0.2 N·m to the cut
    DOUBLES_EQUAL(0.2 / 0.004,
                  drive.tangential_force_N(braking, 4.0).value - drive.tangential_force_N(at_current(12.0), 4.0).value,
                  1e-6);
}

TEST(SpindleDrive, gives_less_torque_per_ampere_in_field_weakening) {
    auto p = paper_spindle();
    p.K_t2_Nm = 0.0;
    p.base_speed_rad_s = 200.0;
    const SpindleDrive<double> drive(p);
    const double below = drive.tangential_force_N(at_current(10.0, 150.0), 4.0).value;
    const double above = drive.tangential_force_N(at_current(10.0, 400.0), 4.0).value;
    DOUBLES_EQUAL(0.5, above / below, 1e-9);
}

TEST(SpindleDrive, learns_its_idle_torque_in_air_and_doubts_it_again_with_time) {
    SpindleDrive<double> drive(paper_spindle());
    const double before = drive.tangential_force_N(at_current(9.0), 4.0).variance;
    for (int k = 0; k < 50; ++k) {
        drive.rezero(at_current(9.0));
    }
    const auto rezeroed = drive.tangential_force_N(at_current(9.0), 4.0);
    DOUBLES_EQUAL(0.0, rezeroed.value, 10.0);
    CHECK(rezeroed.variance < before);
    drive.predict(100.0);
    CHECK(drive.tangential_force_N(at_current(9.0), 4.0).variance > rezeroed.variance);
}

TEST(SpindleDrive, does_not_take_an_inertia_that_is_off_for_idle_torque_while_it_runs_up) {
    auto p = paper_spindle();
    p.inertia_kg_m2 = 0.004;
    SpindleDrive<double> drive(p);
    auto running_up = at_current(9.7197 + 1.1 * 20.0 / p.K_t1_Nm_per_A);
    running_up.acceleration_rad_s2 = 5000.0;  // 20 N·m by the inertia that is told, a tenth less than the true one
    drive.rezero(running_up);
    CHECK(std::abs(drive.drift_Nm()) < 0.02);
}

TEST(SpindleDrive, does_not_learn_a_dead_current_as_idle_torque) {
    SpindleDrive<double> drive(paper_spindle());  // idle torque known to 0.2 N·m of 7.6 N·m
    drive.rezero(at_current(0.0));
    CHECK(drive.is_implausible());
    DOUBLES_EQUAL(0.0, drive.drift_Nm(), 1e-12);
    CHECK_FALSE(drive.tangential_force_N(at_current(15.0), 4.0).valid);
    drive.rezero(at_current(9.8));
    CHECK_FALSE(drive.is_implausible());
    CHECK(drive.tangential_force_N(at_current(15.0), 4.0).valid);
}

TEST(SpindleDrive, takes_more_torque_than_its_idle_torque_can_be_for_a_cut_and_less_for_none) {
    auto p = paper_spindle();  // known to 0.2 N·m
    p.warm_up_torque_Nm = 2.0;
    p.warm_up_torque_sd_Nm = 0.05;
    p.warm_up_time_s = 200.0;
    SpindleDrive<double> cold(p);
    const auto at_idle_and = [&](double torque_Nm) { return at_current((torque_Nm - p.K_t2_Nm) / p.K_t1_Nm_per_A); };
    for (const double torque_Nm : std::array{-1.0, 0.5, 3.5}) {  // 2.0 is right
        cold.rezero(at_idle_and(torque_Nm));
        CHECK(cold.is_implausible());
        const bool is_cut = torque_Nm > 2.0;
        CHECK_EQUAL(is_cut, cold.find_hidden_cut());
        CHECK_EQUAL(!is_cut, cold.is_implausible());
    }
    cold.rezero(at_idle_and(2.0));
    CHECK_FALSE(cold.find_hidden_cut());
}

TEST(SpindleDrive, doubts_its_gain_where_much_of_the_idle_torque_is_missing) {
    auto p = paper_spindle();  // idles at 9.72 A
    p.idle_torque_sd_Nm = 2.0;
    SpindleDrive<double> sound(p);
    sound.rezero(at_current(9.72 - 2.0));
    DOUBLES_EQUAL(0.0, sound.gain_doubt(), 0.0);
    SpindleDrive<double> weak(p);
    weak.rezero(at_current(0.3 * 9.72));
    DOUBLES_EQUAL(1.0 / 0.3 - 1.0, weak.gain_doubt(), 0.05);
}

TEST(SpindleDrive, does_not_doubt_its_gain_where_the_current_is_as_noisy_in_air_as_stated) {
    auto p = paper_spindle();
    p.idle_torque_sd_Nm = 2.0;
    p.current_sd_A = 0.1;
    constexpr double samples = 10.0;
    constexpr double N_per_Nm = 250.0;
    const double usual_A = std::sqrt(2.0 / samples) * p.current_sd_A;
    const auto doubt_with_noise = [&](double share) {
        SpindleDrive<double> drive(p);
        drive.rezero(at_current(0.3 * 9.72));
        for (int k = 0; k < 20; ++k) {
            drive.learn_noise(drive.change_N(share * usual_A, 100.0, samples, N_per_Nm));
        }
        return drive.gain_doubt();
    };
    DOUBLES_EQUAL(0.0, doubt_with_noise(1.0), 0.0);
    DOUBLES_EQUAL(0.0, doubt_with_noise(2.0), 0.0);
    DOUBLES_EQUAL(1.0 / 0.3 - 1.0, doubt_with_noise(0.3), 0.05);
}

TEST(SpindleDrive, doubts_its_gain_although_a_cut_that_a_weak_current_hides_is_noisy) {
    auto p = paper_spindle();
    p.idle_torque_sd_Nm = 2.0;
    SpindleDrive<double> weak(p);
    weak.rezero(at_current(0.3 * 9.72));
    for (int k = 0; k < 100; ++k) {
        weak.learn_noise(weak.change_N(k < 24 ? 0.0 : 1.0, 100.0, 10.0, 250.0));
    }
    CHECK(weak.gain_doubt() > 1.0);
}

TEST(SpindleDrive, does_not_doubt_its_gain_where_the_idle_torque_is_too_high) {
    auto p = paper_spindle();
    p.idle_torque_sd_Nm = 2.0;
    SpindleDrive<double> drive(p);
    drive.rezero(at_current(15.0));
    DOUBLES_EQUAL(0.0, drive.gain_doubt(), 0.0);
}

TEST(SpindleDrive, keeps_its_doubt_of_the_gain_where_it_then_learns_a_hidden_cut_as_idle_torque) {
    auto p = paper_spindle();
    p.idle_torque_sd_Nm = 2.0;
    SpindleDrive<double> weak(p);
    weak.rezero(at_current(0.4 * 9.72));
    const double doubt = weak.gain_doubt();
    for (int k = 0; k < 20; ++k) {
        weak.rezero(at_current(8.0));
    }
    DOUBLES_EQUAL(doubt, weak.gain_doubt(), 0.0);
}

TEST(SpindleDrive, has_no_estimate_without_current_or_rotation) {
    const SpindleDrive<double> drive(paper_spindle());
    auto absent = at_current(12.0);
    absent.present = false;
    CHECK_FALSE(drive.tangential_force_N(absent, 4.0).valid);
    CHECK_FALSE(drive.tangential_force_N(at_current(12.0, 0.0), 4.0).valid);
}

TEST(SpindleDrive, doubts_its_zero_at_another_speed_until_it_is_zeroed_there) {
    auto p = paper_spindle();
    p.idle_torque_sd_Nm = 0.4;
    p.gain_relative_sd = 0.0;
    SpindleDrive<double> drive(p);
    const auto idle = [](double speed_rad_s) { return at_current(9.72, speed_rad_s); };
    const auto doubt_Nm = [&](double speed_rad_s) {
        return std::sqrt(drive.tangential_force_N(idle(speed_rad_s), 1000.0).variance);
    };
    for (int k = 0; k < 50; ++k) {
        drive.rezero(idle(400.0));
    }
    CHECK(doubt_Nm(400.0) < 0.02);
    DOUBLES_EQUAL(0.1, doubt_Nm(300.0), 0.01);
    for (int k = 0; k < 50; ++k) {
        drive.rezero(idle(300.0));
    }
    CHECK(doubt_Nm(300.0) < 0.02);
}
