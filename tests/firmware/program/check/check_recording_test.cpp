// SPDX-License-Identifier: Apache-2.0
#include "check/check_recording.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <utility>

#include "check/order_spectrum.hpp"
#include "firmware/program/check/made_recording.hpp"
#include "temporary_folder.hpp"

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

constexpr const char* nothing_but_the_basis =
    "note: spindle: whether the current is peak or rms cannot be told: a factor of 1.41 is within the stated deviation "
    "of the idle torque [spindle.idle_torque_sd_Nm]\n";

void scale_axis_currents(MadeRecording& recording, float factor) {
    for (RecordedSample& sample : recording) {
        for (float& current : sample.drives.axis_current_A) {
            current *= factor;
        }
    }
}

/// What an encoder with so many times the counts would have counted.
MadeRecording with_counts_times(MadeRecording recording, double factor) {
    return changed(std::move(recording), [factor](hal::DriveSample& drives) {
        drives.spindle_count = static_cast<std::uint32_t>(std::lround(drives.spindle_count * factor));
        drives.spindle_index_count = static_cast<std::uint32_t>(std::lround(drives.spindle_index_count * factor));
    });
}

}  // namespace

TEST_GROUP(RecordingCheck) {
    firmware::Parameters<float> parameters = right_parameters();
    MadeRecording right = made_recording({});

    void check_says(const std::string& lines, const char* part) const {
        if (!contains(lines, part)) {
            STRCMP_EQUAL(part, lines.c_str());
        }
    }
};

TEST(RecordingCheck, finds_nothing_on_the_right_machine_whatever_its_noise) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        STRCMP_EQUAL(nothing_but_the_basis, lines_for(made_recording({.seed = seed}), parameters).c_str());
    }
}

TEST(RecordingCheck, finds_nothing_where_the_friction_is_off_by_its_stated_deviation) {
    for (const double friction_scale : {0.8, 1.2}) {
        STRCMP_EQUAL(nothing_but_the_basis,
                     lines_for(made_recording({.seed = 9, .friction_scale = friction_scale}), parameters).c_str());
    }
}

TEST(RecordingCheck, finds_nothing_without_a_rest_where_the_quietest_part_is_taken_for_air) {
    STRCMP_EQUAL(nothing_but_the_basis, lines_for(made_recording({.has_rest = false}), parameters).c_str());
}

TEST(RecordingCheck, finds_a_spindle_current_that_is_reversed) {
    const auto wrong = changed(right, [](hal::DriveSample& drives) { drives.spindle_current_A *= -1.0F; });
    check_says(lines_for(wrong, parameters), "error: spindle: the current is reversed");
    check_says(lines_for(wrong, parameters), "[bus.spindle.current_reversed]");
}

TEST(RecordingCheck, finds_a_spindle_current_that_is_reversed_in_a_recording_without_air) {
    const auto wrong = changed(made_recording({.has_air = false}),
                               [](hal::DriveSample& drives) { drives.spindle_current_A *= -1.0F; });
    check_says(lines_for(wrong, parameters), "error: spindle: the current is reversed");
}

TEST(RecordingCheck, finds_a_spindle_current_that_is_dead) {
    const auto constant = changed(right, [](hal::DriveSample& drives) { drives.spindle_current_A = 0.0F; });
    check_says(lines_for(constant, parameters), "error: spindle: the current stands at 0 A while it turns");
    int k = 0;
    const auto noise = changed(
        right, [&k](hal::DriveSample& drives) { drives.spindle_current_A = 0.05F * static_cast<float>(++k % 3 - 1); });
    check_says(lines_for(noise, parameters), "error: spindle: no current while it turns in air");
}

TEST(RecordingCheck, finds_a_spindle_current_in_mA) {
    const auto wrong = changed(right, [](hal::DriveSample& drives) { drives.spindle_current_A *= 1000.0F; });
    check_says(lines_for(wrong, parameters), "expected at most 48 A; is it in mA");
}

TEST(RecordingCheck, finds_peak_for_rms_by_the_idle_torque_where_that_is_known_well) {
    parameters.machine.spindle.idle_torque_sd_Nm = 0.05F;
    parameters.machine.spindle.warm_up_torque_sd_Nm = 0.02F;
    const MadeRecording at_calibrated_speed = made_recording({.spindle_rpm = 4000.0});
    STRCMP_EQUAL("", lines_for(at_calibrated_speed, parameters).c_str());
    const auto wrong =
        changed(at_calibrated_speed, [](hal::DriveSample& drives) { drives.spindle_current_A *= 1.414F; });
    check_says(lines_for(wrong, parameters), "a current in peak instead of rms amperes does that");
    check_says(lines_for(wrong, parameters), "[bus.spindle.current_basis]");
}

TEST(RecordingCheck, finds_the_idle_torque_of_another_spindle) {
    const auto wrong = changed(right, [](hal::DriveSample& drives) { drives.spindle_current_A *= 3.0F; });
    check_says(lines_for(wrong, parameters), "the idle torque of another machine");
}

TEST(RecordingCheck, warns_of_an_idle_torque_so_low_that_the_controller_doubts_the_gain) {
    const auto weak = changed(right, [](hal::DriveSample& drives) { drives.spindle_current_A *= 0.35F; });
    check_says(lines_for(weak, parameters), "the controller counts on it; calibrate the gain, or the idle torque");
    check_says(lines_for(weak, parameters), "[spindle.K_t1_Nm_per_A]");
}

TEST(RecordingCheck, finds_peak_for_rms_where_both_axes_show_the_factor) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        MadeRecording wrong = made_recording({.seed = seed});
        scale_axis_currents(wrong, 1.414F);
        const std::string lines = lines_for(wrong, parameters);
        check_says(lines, "warning: x: the friction in air is 1.4");
        check_says(lines, "[bus.y.current_basis]");
        scale_axis_currents(wrong, 0.5F);
        check_says(lines_for(wrong, parameters), "a current in rms instead of peak amperes does that");
    }
}

TEST(RecordingCheck, says_that_one_axis_with_the_factor_may_be_its_friction) {
    const auto wrong = changed(right, [](hal::DriveSample& drives) { drives.axis_current_A[0] *= 1.414F; });
    check_says(lines_for(wrong, parameters), "note: x: the friction in air is 1.4");
}

TEST(RecordingCheck, finds_peak_for_rms_of_one_axis_whose_friction_is_known_well) {
    parameters.machine.axes[0].friction_relative_sd = 0.05F;
    parameters.machine.axes[0].friction_ripple_A = 0.02F;
    STRCMP_EQUAL(nothing_but_the_basis, lines_for(right, parameters).c_str());
    const auto wrong = changed(right, [](hal::DriveSample& drives) { drives.axis_current_A[0] *= 1.414F; });
    check_says(lines_for(wrong, parameters), "warning: x: the friction in air is 1.4");
}

TEST(RecordingCheck, finds_an_axis_current_that_is_reversed) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const auto wrong = changed(right, [axis](hal::DriveSample& drives) { drives.axis_current_A[axis] *= -1.0F; });
        const std::string lines = lines_for(wrong, parameters);
        check_says(lines, axis == 0 ? "error: x: the current is reversed" : "error: y: the current is reversed");
        check_says(lines, axis == 0 ? "[bus.x.current_reversed]" : "[bus.y.current_reversed]");
    }
}

TEST(RecordingCheck, finds_an_axis_current_that_is_dead) {
    const auto constant = changed(right, [](hal::DriveSample& drives) { drives.axis_current_A[1] = 0.0F; });
    check_says(lines_for(constant, parameters), "error: y: the current never changes although the axis moves");
    int k = 0;
    const auto noise = changed(
        right, [&k](hal::DriveSample& drives) { drives.axis_current_A[1] = 0.05F * static_cast<float>(++k % 3 - 1); });
    check_says(lines_for(noise, parameters), "error: y: the current does not follow the motion");
}

TEST(RecordingCheck, finds_swapped_axes) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const auto wrong = changed(made_recording({.seed = seed}), [](hal::DriveSample& drives) {
            std::swap(drives.axis_current_A[0], drives.axis_current_A[1]);
        });
        const std::string lines = lines_for(wrong, parameters);
        check_says(lines, "error: x: the current follows the motion of y: are the axes swapped?");
        check_says(lines, "error: y: the current follows the motion of x: are the axes swapped?");
    }
}

TEST(RecordingCheck, finds_an_axis_current_in_mA) {
    MadeRecording wrong = right;
    scale_axis_currents(wrong, 1000.0F);
    check_says(lines_for(wrong, parameters), "is it in mA, or per mille of the rated current? [x_current_A]");
}

TEST(RecordingCheck, finds_the_friction_of_another_machine) {
    const std::string lines = lines_for(made_recording({.friction_scale = 2.2}), parameters);
    check_says(lines, "warning: x: the friction in air is 2.");
    check_says(lines, "of another machine");
}

TEST(RecordingCheck, finds_velocities_in_mm_per_min) {
    const auto wrong = changed(right, [](hal::DriveSample& drives) {
        for (float& velocity : drives.axis_velocity_mm_s) {
            velocity *= 60.0F;
        }
    });
    check_says(lines_for(wrong, parameters), "is it in mm/min? [x_velocity_mm_s]");
}

TEST(RecordingCheck, finds_velocities_in_mm_per_min_of_a_slow_feed_by_the_programmed_one) {
    parameters.tool.diameter_mm = 100.0F;  // takes any of these chips
    const auto wrong = changed(right, [](hal::DriveSample& drives) {
        for (float& velocity : drives.axis_velocity_mm_s) {
            velocity *= 10.0F;
        }
    });
    check_says(lines_for(wrong, parameters), "times the programmed one, expected at most override_max = 2");
}

TEST(RecordingCheck, finds_a_programmed_feed_in_mm_per_min) {
    const auto wrong = changed(right, [](hal::DriveSample& drives) {
        for (float& velocity : drives.axis_velocity_mm_s) {
            velocity /= 60.0F;
        }
    });
    parameters.machine.axes[0].velocity_floor_mm_s = 0.1F;
    check_says(lines_for(wrong, parameters), "[programmed_feed_mm_s]");
}

TEST(RecordingCheck, finds_a_feed_below_the_velocity_floor) {
    parameters.machine.axes[0].velocity_floor_mm_s = 60.0F;
    check_says(lines_for(right, parameters), "warning: x: no force below 60 mm/s, and the feed of the recording is");
}

TEST(RecordingCheck, finds_wrong_counts_per_revolution_by_the_index_pulses) {
    for (const double factor : {0.5, 2.0, 1.25}) {
        const std::string lines = lines_for(with_counts_times(right, factor), parameters);
        check_says(lines, "error: spindle: from one index pulse to the next the recorded angle turns by");
        check_says(lines, factor == 0.5   ? ": 4096 counts per revolution instead of 8192?"
                          : factor == 2.0 ? ": 16384 counts per revolution instead of 8192?"
                                          : ": 10240 counts per revolution instead of 8192?");
    }
}

TEST(RecordingCheck, finds_wrong_counts_per_revolution_by_the_teeth_where_no_index_is_recorded) {
    check_says(lines_for(right, parameters, false), "note: spindle: no index pulses in the recording");
    check_says(lines_for(with_counts_times(right, 0.5), parameters, false),
               "or spindle.encoder_counts_per_rev is wrong");
    check_says(lines_for(with_counts_times(right, 0.6), parameters, false), "which no whole number of teeth does");
}

TEST(RecordingCheck, finds_a_spindle_that_turns_backwards) {
    const auto wrong =
        changed(right, [](hal::DriveSample& drives) { drives.spindle_count = 0U - drives.spindle_count; });
    check_says(lines_for(wrong, parameters, false), "error: spindle: it turns backwards");
}

TEST(RecordingCheck, finds_a_wrong_number_of_teeth) {
    struct Case {
        int teeth;
        std::uint8_t stated;
    };
    for (const Case& c :
         {Case{4, 2}, Case{4, 3}, Case{4, 5}, Case{2, 4}, Case{3, 4}, Case{2, 3}, Case{5, 4}, Case{2, 1}}) {
        parameters.tool.teeth = c.stated;
        const std::string lines = lines_for(made_recording({.teeth = c.teeth, .spindle_rpm = 2000.0}), parameters);
        const std::string expected = "warning: the cut repeats " + std::to_string(c.teeth) +
                                     " times per revolution, and the tool has " + std::to_string(c.stated);
        check_says(lines, expected.c_str());
    }
}

TEST(RecordingCheck, finds_a_wrong_number_of_teeth_by_a_force_sensor_that_sees_many_harmonics) {
    parameters.machine.cnc.sample_rate_hz = 4000.0F;
    const auto with_force =
        changed(made_recording({.rate_hz = 4000.0, .spindle_rpm = 2000.0}), [](hal::DriveSample& drives) {
            const bool in_cut = drives.time_us > 7'000'000 && drives.time_us < 11'000'000;
            const bool tooth_cuts = drives.spindle_count % 2048 < 256;  // four teeth, each for 11°
            drives.force_N = {in_cut && tooth_cuts ? 300.0F : 0.0F, 0.0F};
            hal::set_present(drives, hal::Present::force_sensor);
        });
    STRCMP_EQUAL(nothing_but_the_basis, lines_for(with_force, parameters).c_str());
    for (const int stated : {2, 3, 6, 8}) {
        parameters.tool.teeth = static_cast<std::uint8_t>(stated);
        check_says(lines_for(with_force, parameters), "warning: the cut repeats 4 times per revolution");
    }
}

TEST(RecordingCheck, accepts_the_right_number_of_teeth) {
    for (int teeth = 1; teeth <= 5; ++teeth) {
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            parameters.tool.teeth = static_cast<std::uint8_t>(teeth);
            const std::string lines =
                lines_for(made_recording({.seed = seed, .teeth = teeth, .spindle_rpm = 2000.0}), parameters);
            STRCMP_EQUAL(nothing_but_the_basis, lines.c_str());
        }
    }
}

TEST(RecordingCheck, cannot_tell_the_teeth_where_the_samples_are_too_slow) {
    check_says(lines_for(made_recording({.rate_hz = 250.0}), parameters),
               "note: the number of teeth is not compared: 1.3 samples per tooth; it takes 2.5");
}

TEST(RecordingCheck, takes_a_spindle_current_that_comes_seldom_for_no_more_than_it_is) {
    parameters.machine.spindle_load_period_s = 0.05F;
    int k = 0;
    float held_A = 0.0F;
    const auto seldom = changed(right, [&](hal::DriveSample& drives) {
        held_A = k++ % 50 == 0 ? drives.spindle_current_A : held_A;
        drives.spindle_current_A = held_A;
    });
    const std::string lines = lines_for(seldom, parameters);
    check_says(lines, "note: the number of teeth is not compared: the spindle's current comes too seldom");
    CHECK_FALSE(contains(lines, "error"));
    CHECK_FALSE(contains(lines, "warning"));
}

TEST(RecordingCheck, cannot_tell_one_tooth_that_cuts_from_runout) {
    check_says(lines_for(made_recording({.teeth = 1}), parameters), "by its runout or because a single tooth cuts");
}

TEST(RecordingCheck, cannot_tell_the_teeth_without_a_cut) {
    check_says(lines_for(made_recording({.has_cut = false}), parameters), "note: the number of teeth is not compared");
}

TEST(RecordingCheck, says_what_it_cannot_judge_without_air) {
    const std::string lines = lines_for(made_recording({.has_air = false}), parameters);
    check_says(lines, "note: spindle: no air is known in the recording");
    check_says(lines, "note: x: no steady motion in air");
    check_says(lines, "note: y: it never moves at a steady feed");
    CHECK_FALSE(contains(lines, "error"));
    CHECK_FALSE(contains(lines, "warning"));
}

TEST(RecordingCheck, says_that_an_axis_never_moved) {
    check_says(lines_for(made_recording({.has_y = false}), parameters), "note: y: it never moves at a steady feed");
}

TEST(RecordingCheck, finds_an_angle_in_degrees) {
    const TemporaryFolder folder;
    std::ostringstream csv;
    csv << "time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s\n";
    for (int k = 0; k < 500; ++k) {
        csv << 0.001 * k << ',' << std::fmod(18.0 * k, 360.0) << ",1.4,1.6,10\n";
    }
    const std::string lines = lines_of(check_recording(folder.write("degrees.csv", csv.str()), parameters));
    check_says(lines, "is it in degrees? [spindle_angle_rad]");
}

TEST(RecordingCheck, survives_values_of_any_size) {
    int k = 0;
    const auto absurd = changed(right, [&k](hal::DriveSample& drives) {
        const float value = ++k % 3 == 0 ? 3e38F : k % 3 == 1 ? -3e38F : std::numeric_limits<float>::infinity();
        drives.spindle_current_A = drives.axis_current_A[0] = drives.axis_velocity_mm_s[1] = value;
        drives.spindle_count = drives.spindle_index_count = static_cast<std::uint32_t>(k) * 2654435761U;
        drives.spindle_index_number = static_cast<std::uint8_t>(k % 255 + 1);
    });
    check_says(lines_for(absurd, parameters), "error: spindle: ");
}

TEST(RecordingCheck, judges_nothing_in_a_recording_that_is_too_short) {
    STRCMP_EQUAL("note: too short, or too few samples per second, to judge anything [time_s]\n",
                 lines_for({right.begin(), right.begin() + 50}, parameters).c_str());
}

TEST(RecordingCheck, finds_a_time_in_ms) {
    for (RecordedSample& sample : right) {
        sample.time_s *= 1000.0;
    }
    check_says(lines_for(right, parameters),
               "error: 1 samples per second, and the machine's file says 1000; is the "
               "time in ms? [time_s]");
}

TEST_GROUP(OrderSpectrum){/// 100 revolutions of a sine of an order, 20 samples per revolution.
                          static OrderSpectrum of(double order){OrderBlocks blocks;
for (int k = 0; k < 2000; ++k) {
    const double noise = 0.1 * std::sin(12.9898 * k * k);
    blocks.add(0.001 * k, 0.05, std::sin(2.0 * std::numbers::pi * order * 0.05 * k) + noise);
}
OrderSpectrum spectrum;
for (const OrderBlock& block : blocks.blocks()) {
    spectrum.add(block);
}
return spectrum;
}
}
;

TEST(OrderSpectrum, has_a_line_where_the_signal_has_one_and_nowhere_else) {
    const OrderSpectrum spectrum = of(3.0);
    LONGS_EQUAL(12, spectrum.blocks());
    LONGS_EQUAL(8, spectrum.highest_order());
    for (std::size_t order = 1; order <= 8; ++order) {
        CHECK_EQUAL(order == 3, spectrum.line(8 * order) > 0.0);
    }
    DOUBLES_EQUAL(1.0 / 16.0, spectrum.power(24), 0.002);  // of amplitude 1: (½ · ½)²
}

TEST(OrderSpectrum, has_no_line_with_fewer_blocks_than_tell_one_from_noise) {
    OrderBlocks blocks;
    for (int k = 0; k < 1000; ++k) {
        blocks.add(0.001 * k, 0.05, std::sin(2.0 * std::numbers::pi * 3.0 * 0.05 * k));
    }
    OrderSpectrum spectrum;
    spectrum.add(blocks.blocks().front());
    DOUBLES_EQUAL(0.0, spectrum.line(24), 0.0);
}
