// SPDX-License-Identifier: Apache-2.0
#include "reproduce/hwang_runs.hpp"

#include <cmath>

#include "estimation/drives/feed_force_observer.hpp"
#include "estimation/signal/encoder_angle.hpp"
#include "machine/machine_plant.hpp"

namespace millforce::sim {

namespace {

constexpr int calibration_revolutions = 16;

estimation::ForceDropSample<float> as_float(const BenchSample& sample) {
    return {static_cast<float>(sample.angle_rev), static_cast<float>(sample.dt_s), static_cast<float>(sample.fx_N),
            static_cast<float>(sample.fy_N)};
}

/// Jump and averages of one cut of known immersion.
estimation::ForceDropMeasurement<float> measure_known_cut(const BenchCut& cut, std::uint64_t seed) {
    auto settings = force_drop_settings(cut, calibration_revolutions);
    settings.known_immersion = static_cast<float>(cut.immersion);
    FloatForceDrop force_drop({}, settings);
    for (const BenchSample& sample : bench_samples(cut, {.seed = seed}, calibration_revolutions + 0.1)) {
        if (force_drop.add(as_float(sample), static_cast<float>(cut.feed_per_tooth_mm))) {
            return force_drop.measurement();
        }
    }
    return {};
}

/// Both feed axes: forces in the feed frame, one sample late.
class DriveForces {
  public:
    explicit DriveForces(double feed_direction_rad)
        : cosine_(static_cast<float>(std::cos(feed_direction_rad))),
          sine_(static_cast<float>(std::sin(feed_direction_rad))),
          x_(settings_of(0)),
          y_(settings_of(1)) {}

    struct Forces {
        bool valid = false;
        float along_N = 0.0F;
        float across_N = 0.0F;
    };
    Forces add(float dt_s, const hal::DriveSample& sample) {
        const auto x =
            x_.add(dt_s, sample.axis_current_A[0], sample.axis_velocity_mm_s[0], cosine_ < 0.0F ? -1.0F : 1.0F);
        const auto y =
            y_.add(dt_s, sample.axis_current_A[1], sample.axis_velocity_mm_s[1], sine_ < 0.0F ? -1.0F : 1.0F);
        return {x.valid && y.valid, cosine_ * x.value + sine_ * y.value, cosine_ * y.value - sine_ * x.value};
    }

  private:
    /// Force constant and moved mass from the drive's data sheet and the machine's commissioning.
    static estimation::FeedForceObserverSettings<float> settings_of(std::size_t axis) {
        const FeedPlantSettings plant = MachinePlantSettings::standard_axes()[axis];
        return {static_cast<float>(plant.force_constant_N_per_A), static_cast<float>(plant.mass_kg)};
    }

    float cosine_;
    float sine_;
    estimation::FeedForceObserver<float> x_;
    estimation::FeedForceObserver<float> y_;
};

}  // namespace

estimation::ForceDropSettings<float> force_drop_settings(const BenchCut& cut, int revolutions) {
    estimation::ForceDropSettings<float> settings;
    settings.detector.teeth = cut.teeth;
    settings.revolutions = revolutions;
    settings.zero_drift_sd_N = 2.0F;
    return settings;
}

std::vector<estimation::ForceDropCalibrationCut> calibration_cuts(const BenchMaterial& material, bool up_milling,
                                                                  std::uint64_t seed) {
    std::vector<estimation::ForceDropCalibrationCut> cuts;
    int number = 0;
    for (const double feed_mm : {0.10, 0.15, 0.20}) {
        for (const double immersion : {0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}) {
            const BenchCut cut{.feed_per_tooth_mm = feed_mm,
                               .material = material,
                               .up_milling = up_milling,
                               .immersion = immersion,
                               .runout_angle_rad = 0.3 * number};
            ++number;
            const auto measured = measure_known_cut(cut, seed * 1000U + static_cast<std::uint64_t>(number));
            cuts.push_back({estimation::in_double(measured), cut.axial_depth_mm, immersion});
        }
    }
    return cuts;
}

estimation::ForceDropCalibration calibration_of(const std::vector<estimation::ForceDropCalibrationCut>& cuts) {
    estimation::ForceDropCalibration calibration;
    for (const estimation::ForceDropCalibrationCut& cut : cuts) {
        calibration.add(cut);
    }
    return calibration;
}

std::vector<ForceDropRun> run_force_drop(const FittedForceDropLaw& law, const BenchCut& cut, int revolutions,
                                         const std::vector<BenchSample>& samples) {
    FloatForceDrop force_drop(estimation::in_float(law), force_drop_settings(cut, revolutions));
    std::vector<ForceDropRun> runs;
    double seen = 0.0;
    for (const BenchSample& sample : samples) {
        seen += 1.0 / bench_samples_per_rev;
        if (force_drop.add(as_float(sample), static_cast<float>(cut.feed_per_tooth_mm))) {
            runs.push_back({sample.immersion, force_drop.estimate(), seen});
        }
    }
    return runs;
}

std::vector<ForceDropRun> run_force_drop_on_drives(const FittedForceDropLaw& law, const DriveCut& drive_cut,
                                                   int revolutions, const DriveRecording& recording) {
    auto settings = force_drop_settings(drive_cut.cut, revolutions);
    settings.detector.response.corner_hz = static_cast<float>(0.44 / (2.0 * drive_cut.sample_s));
    settings.mean_force_sd_N = 10.0F;
    FloatForceDrop force_drop(estimation::in_float(law), settings);
    estimation::EncoderAngle<float> encoder(recording.encoder_counts_per_rev);
    DriveForces forces(drive_cut.feed_direction_rad);
    std::vector<ForceDropRun> runs;
    float angle_before_rev = 0.0F;
    double seen = 0.0;
    for (const hal::DriveSample& sample : recording.samples) {
        const auto reading =
            encoder.update(sample.spindle_count, sample.spindle_index_count, sample.spindle_index_number);
        const auto dt_s = static_cast<float>(drive_cut.sample_s);
        const auto force = forces.add(dt_s, sample);
        seen += static_cast<double>(reading.turned_rev);
        if (!force.valid) {
            force_drop.restart();
        } else if (force_drop.add({angle_before_rev, dt_s, force.along_N, force.across_N},
                                  static_cast<float>(drive_cut.cut.feed_per_tooth_mm))) {
            runs.push_back({drive_cut.cut.immersion, force_drop.estimate(), seen});
        }
        angle_before_rev = reading.angle_rev;
    }
    return runs;
}

}  // namespace millforce::sim
