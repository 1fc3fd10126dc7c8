// SPDX-License-Identifier: Apache-2.0
#include "calibration/friction_calibration.hpp"
#include "files/csv.hpp"
#include "firmware/tick_bench.hpp"
#include "temporary_folder.hpp"

#include <toml++/toml.h>  // before CppUTest, which makes `new` a macro

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <sstream>
#include <vector>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

/// The measured axis moves without a load, so what the tick makes of it is no cutting force but an error.

namespace {

constexpr double force_constant_N_per_A = 35.15;
constexpr double step_s = 0.005;

struct AxisSample {
    double position_m = 0.0;
    double motor_force_N = 0.0;
};

std::vector<AxisSample> measured_axis() {
    CsvReader csv(MILLFORCE_TEST_DATA "/ball_screw_axis_200hz.csv");
    const CsvColumn position = csv.require("position_m");
    const CsvColumn force = csv.require("motor_force_N");
    std::vector<AxisSample> samples;
    while (csv.next_row()) {
        samples.push_back({csv.number(position), csv.number(force)});
    }
    return samples;
}

/// As `millforce calibrate friction` writes it.
estimation::FeedDriveParameters<float> calibrated(const std::vector<AxisSample>& samples) {
    const TemporaryFolder folder;
    std::ostringstream text;
    text.precision(10);
    text << "time_s,position_m,motor_force_N\n";
    for (std::size_t k = 0; k < samples.size(); ++k) {
        text << step_s * static_cast<double>(k) << ',' << samples[k].position_m << ',' << samples[k].motor_force_N
             << '\n';
    }
    FrictionCalibrationOptions options;
    options.data = {folder.write("half.csv", text.str())};
    options.output = folder.path("axis.toml");
    options.force_constant_N_per_A = force_constant_N_per_A;
    std::ostringstream out;
    LONGS_EQUAL(0, calibrate_friction(options, out));
    const toml::table file = toml::parse(folder.read("axis.toml"));
    const auto value = [&](const char* key) { return file["x"][key].value_or(std::nanf("")); };
    estimation::FeedDriveParameters<float> axis;
    axis.positive.K_x2_A_min_per_m = value("K_x2_positive_A_min_per_m");
    axis.negative.K_x2_A_min_per_m = value("K_x2_negative_A_min_per_m");
    axis.K_x3_A = value("K_x3_A");
    axis.gravity_A = value("gravity_A");
    axis.K_x4_N_per_A = value("K_x4_N_per_A");
    axis.mass_kg = value("mass_kg");
    axis.current_sd_A = 0.05F;
    axis.friction_ripple_A = 0.03F;
    return axis;
}

struct Phantom {
    int estimates = 0;
    double rms_N = 0.0;
    double within_two_sd = 0.0;
};

/// In a feed move in air at that speed of an idle spindle.
Phantom phantom_force(const estimation::FeedDriveParameters<float>& axis, const std::vector<AxisSample>& samples,
                      std::size_t from, double spindle_rpm) {
    Parameters machine = machine_and_tool();
    machine.machine.axes[0] = axis;
    firmware::ForceControlTick<float> tick(machine);
    hal::ProgramStatus air = program();
    air.programmed_feed_mm_s = 150.0F;
    Phantom phantom;
    double sum_N2 = 0.0;
    int within = 0;
    for (std::size_t k = 1; k + 1 < samples.size(); ++k) {
        hal::DriveSample sample;
        sample.time_us = static_cast<std::uint32_t>(std::lround(1e6 * step_s * static_cast<double>(k)));
        sample.spindle_count =
            static_cast<std::uint32_t>(spindle_rpm / 60.0 * step_s * static_cast<double>(k) * 4096.0);
        sample.present = hal::all_present;
        sample.spindle_current_A = -machine.machine.spindle.K_t2_Nm / machine.machine.spindle.K_t1_Nm_per_A;
        sample.axis_current_A[0] = static_cast<float>(samples[k].motor_force_N / force_constant_N_per_A);
        sample.axis_velocity_mm_s[0] =
            static_cast<float>(1000.0 * (samples[k + 1].position_m - samples[k - 1].position_m) / (2.0 * step_s));
        tick.take(sample);
        while (tick.work_due()) {
            tick.work();
        }
        const bool is_new = tick.has_new_estimate();
        tick.answer(air);
        const estimation::Measurement<float>& x_N = tick.estimate().x_N;
        if (k < from || !is_new || !x_N.valid) {
            continue;
        }
        ++phantom.estimates;
        sum_N2 += static_cast<double>(x_N.value * x_N.value);
        within += x_N.value * x_N.value < 4.0F * x_N.variance ? 1 : 0;
    }
    phantom.rms_N = std::sqrt(sum_N2 / phantom.estimates);
    phantom.within_two_sd = static_cast<double>(within) / phantom.estimates;
    return phantom;
}

}  // namespace

TEST_GROUP(MeasuredAxisInTick) {
    const std::vector<AxisSample> samples = measured_axis();
    const std::size_t half = samples.size() / 2;
    const estimation::FeedDriveParameters<float> axis{
        calibrated({samples.begin(), samples.begin() + static_cast<long>(half)})};
};

TEST(MeasuredAxisInTick, calibrated_on_the_first_half_feels_no_cut_in_the_second) {
    for (const double spindle_rpm : {600.0, 955.0, 2000.0}) {
        const Phantom phantom = phantom_force(axis, samples, half, spindle_rpm);
        CHECK(phantom.estimates > 400);
        CHECK(phantom.rms_N < 1.2);
        CHECK(phantom.rms_N > 0.3);  // friction that is this even was not measured
        CHECK(phantom.within_two_sd > 0.95);
    }
}
