// SPDX-License-Identifier: Apache-2.0
#include "synthetic_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "control/cut_state.hpp"

namespace millforce::sim::synthetic {

namespace {

constexpr double interval_s = 0.02;
constexpr double limit_N = 400.0;
constexpr double programmed_feed_mm_s = 12.0;
constexpr double rapid_feed_mm_s = 80.0;
constexpr double level_depth_mm = 2.0;

struct Segment {
    double x_mm;
    double y_mm;
    double z_mm;
    double radial_immersion;  ///< 0: not in cut
    bool rapid;
};

/// Rectangles of growing size around the middle; the first is a slot, the others step over by 4 mm.
void append_level(std::vector<Segment>& path, double z_mm) {
    path.push_back({0.0, 0.0, 5.0, 0.0, true});
    path.push_back({0.0, 0.0, z_mm + level_depth_mm, 0.0, false});
    path.push_back({15.0, 0.0, z_mm, 2.0, false});
    path.push_back({-15.0, 0.0, z_mm, 2.0, false});
    for (int pass = 1; pass <= 5; ++pass) {
        const double offset_mm = 4.0 * pass;
        const std::array<std::array<double, 2>, 5> corners = {{{-15.0 - offset_mm, -offset_mm},
                                                               {15.0 + offset_mm, -offset_mm},
                                                               {15.0 + offset_mm, offset_mm},
                                                               {-15.0 - offset_mm, offset_mm},
                                                               {-15.0 - offset_mm, -offset_mm}}};
        for (const auto& corner : corners) {
            path.push_back({corner[0], corner[1], z_mm, 0.4, false});
        }
    }
    path.push_back({0.0, 0.0, 5.0, 0.0, true});
}

/// Uniform in −1…1, from a multiplicative congruential generator with a constant seed.
class Noise {
  public:
    double next() {
        state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<double>(state_ >> 11U) * 0x1p-52 - 1.0;
    }

  private:
    std::uint64_t state_ = 20240607;
};

/// An estimate's error, in standard deviations: smooth, as a filter leaves it.
class SlowError {
  public:
    double next(Noise& noise) { return value_ = 0.95 * value_ + 0.5 * noise.next(); }

  private:
    double value_ = 0.0;
};

/// In a corner the tool turns into the material: immersion rises over the last 4 mm.
double immersion_at(const Segment& segment, double remaining_mm) {
    const bool corner = segment.radial_immersion > 0.0 && segment.radial_immersion < 2.0 && remaining_mm < 4.0;
    return segment.radial_immersion + (corner ? 0.6 * (4.0 - remaining_mm) / 4.0 : 0.0);
}

double tooth_force_N(double feed_mm_s, double immersion, double depth_mm) {
    if (immersion <= 0.0) {
        return 0.0;
    }
    const double load_share = 0.2 + 0.8 * std::min(1.0, immersion / 1.3);
    return 195.0 * depth_mm * load_share * std::pow(feed_mm_s / programmed_feed_mm_s, 0.74);
}

double total_over_tooth(double immersion) {
    return 1.0 + 0.45 * std::clamp((immersion - 0.6) / 1.4, 0.0, 1.0);
}

class Machine {
  public:
    explicit Machine(bool controlled) : controlled_(controlled) { override_ = controlled ? 1.0 : 0.98; }

    void follow(const Segment& segment, std::vector<TracePoint>& trace) {
        const double dx = segment.x_mm - at_.x_mm;
        const double dy = segment.y_mm - at_.y_mm;
        const double dz = segment.z_mm - at_.z_mm;
        const double length_mm = std::sqrt(dx * dx + dy * dy + dz * dz);
        for (double done_mm = 0.0; done_mm < length_mm;) {
            const double feed_mm_s = segment.rapid ? rapid_feed_mm_s : programmed_feed_mm_s * override_;
            const double step_mm = std::min(feed_mm_s * interval_s, length_mm - done_mm);
            done_mm += step_mm;
            path_mm_ += step_mm;
            time_s_ += step_mm / feed_mm_s;
            const double share = done_mm / length_mm;
            TracePoint point;
            point.time_s = time_s_;
            point.path_mm = path_mm_;
            point.x_mm = at_.x_mm + share * dx;
            point.y_mm = at_.y_mm + share * dy;
            point.z_mm = at_.z_mm + share * dz;
            point.feed_mm_s = feed_mm_s;
            point.programmed_feed_mm_s = segment.rapid ? rapid_feed_mm_s : programmed_feed_mm_s;
            point.override_ratio = override_;
            point.rapid = segment.rapid;
            cut(point, immersion_at(segment, length_mm - done_mm));
            trace.push_back(point);
        }
        at_ = segment;
    }

  private:
    void cut(TracePoint& point, double immersion) {
        const double depth_mm = level_depth_mm * (immersion > 0.0 ? 1.0 : 0.0);
        const double force_N = tooth_force_N(point.feed_mm_s, immersion, depth_mm) * (1.0 + 0.03 * noise_.next());
        point.true_tooth_force_N = force_N;
        point.true_peak_force_N = force_N * total_over_tooth(immersion);
        point.true_tangential_force_N = 0.6 * force_N;
        point.true_feed_force_N = -0.2 * force_N;
        cutting_intervals_ = immersion > 0.0 ? cutting_intervals_ + 1 : 0;
        if (immersion > 0.0) {
            point.true_radial_immersion = immersion;
            point.true_axial_depth_mm = depth_mm;
            estimate(point, immersion, depth_mm);
        }
        judge(point, force_N, immersion);
    }

    void estimate(TracePoint& point, double immersion, double depth_mm) {
        point.tangential_force_N = point.true_tangential_force_N * (1.0 + 0.04 * noise_.next());
        point.feed_force_N = point.true_feed_force_N * (1.0 + 0.08 * noise_.next());
        point.tooth_force_N = point.true_tooth_force_N * (1.0 + 0.06 * noise_.next());
        const bool nothing_to_tell = std::fmod(path_mm_, 400.0) < 30.0 || cutting_intervals_ < 6;
        if (nothing_to_tell) {
            return;
        }
        point.radial_immersion_sd = 0.05 + 0.02 * immersion;
        point.radial_immersion = immersion + point.radial_immersion_sd * immersion_error_.next(noise_);
        point.axial_depth_sd_mm = 0.05 + 0.12 / immersion;
        point.axial_depth_mm = depth_mm + point.axial_depth_sd_mm * depth_error_.next(noise_);
        point.peak_force_N = point.tooth_force_N * total_over_tooth(point.radial_immersion);
        point.force_limit_N = limit_N * total_over_tooth(point.radial_immersion);
    }

    void judge(TracePoint& point, double force_N, double immersion) {
        using control::CutState;
        using control::Limit;
        CutState state = CutState::air;
        Limit limit = Limit::air_feed;
        double wanted = 1.5;
        if (immersion > 0.0) {
            const bool entry = cutting_intervals_ < 10;
            const bool known = std::isfinite(point.radial_immersion);
            state = entry ? CutState::entry : (known ? CutState::in_cut : CutState::hold);
            limit = entry ? Limit::entry_feed : (known ? Limit::force : Limit::no_estimate);
            wanted = entry ? 0.8 : (known ? override_ * std::pow(0.88 * limit_N / force_N, 1.35) : override_);
        }
        point.state = static_cast<std::uint8_t>(state);
        point.limit = static_cast<std::uint8_t>(controlled_ ? limit : Limit::none);
        if (controlled_ && !point.rapid) {
            override_ += (wanted < override_ ? 0.9 : 0.15) * (std::clamp(wanted, 0.1, 2.5) - override_);
        }
    }

    bool controlled_;
    double override_;
    double time_s_ = 0.0;
    double path_mm_ = 0.0;
    Segment at_{0.0, 0.0, 5.0, 0.0, true};
    int cutting_intervals_ = 0;
    Noise noise_;
    SlowError immersion_error_;
    SlowError depth_error_;
};

void summarise(RunResult& run) {
    RunFigures& figures = run.figures;
    figures.time_s = run.trace.back().time_s;
    figures.path_mm = run.trace.back().path_mm;
    for (const TracePoint& point : run.trace) {
        figures.peak_tooth_force_N = std::max(figures.peak_tooth_force_N, point.true_tooth_force_N);
        figures.time_over_limit_s += point.true_tooth_force_N > limit_N ? interval_s : 0.0;
        figures.cutting_time_s += point.true_tooth_force_N > 0.0 ? interval_s : 0.0;
        figures.mean_force_use += point.true_tooth_force_N / limit_N * interval_s;
        figures.mean_override += point.true_tooth_force_N > 0.0 ? point.override_ratio * interval_s : 0.0;
    }
    figures.mean_force_use /= figures.cutting_time_s;
    figures.mean_override /= figures.cutting_time_s;
    figures.peak_over_limit = figures.peak_tooth_force_N / limit_N;
    figures.longest_over_limit_s = std::min(figures.time_over_limit_s, 0.06);
    figures.reaction_time_s = 0.11;
    figures.real_time_factor = 184.0;
    figures.finished = true;
    if (run.controller == "millforce") {
        figures.immersion_rms = 0.061;
        figures.immersion_coverage = 0.957;
        figures.depth_rms_mm = 0.143;
        figures.depth_coverage = 0.948;
        figures.estimate_share = 0.91;
    }
}

}  // namespace

ScenarioInfo pocket_scenario() {
    ScenarioInfo info;
    info.name = "pocket";
    info.title = "Pocket 80 × 50 mm in two levels";
    info.description =
        "A closed pocket from the middle outwards: a slot first, then passes of 4 mm with sharp corners.";
    info.tool = "4 flutes, Ø10 mm, helix 30°";
    info.material = "SM45C";
    info.seed = 1;
    info.tooth_force_limit_N = limit_N;
    info.cutter_diameter_mm = 10.0;
    info.spindle_speed_rad_s = 314.159;
    info.constant_feed_mm_s = 0.98 * programmed_feed_mm_s;
    info.has_top_view = true;
    info.stock_min_x_mm = -50.0;
    info.stock_min_y_mm = -35.0;
    info.stock_max_x_mm = 50.0;
    info.stock_max_y_mm = 35.0;
    return info;
}

RunResult pocket_run(const std::string& controller) {
    RunResult run;
    run.controller = controller;
    std::vector<Segment> path;
    append_level(path, -level_depth_mm);
    append_level(path, -2.0 * level_depth_mm);
    Machine machine(controller == "millforce");
    for (const Segment& segment : path) {
        machine.follow(segment, run.trace);
    }
    summarise(run);
    return run;
}

}  // namespace millforce::sim::synthetic
