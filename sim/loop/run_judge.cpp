// SPDX-License-Identifier: Apache-2.0
#include "loop/run_judge.hpp"

#include <algorithm>
#include <cmath>

#include "cutting/angle_units.hpp"

namespace millforce::sim {

namespace {

constexpr double band = 1.96;

}  // namespace

RunJudge::RunJudge(const Scenario& scenario)
    : limit_N_(static_cast<double>(scenario.parameters.tool.tooth_force_limit_N)),
      break_N_(limit_N_ * static_cast<double>(scenario.parameters.tool.break_share)),
      latency_s_(static_cast<double>(firmware::reaction_s(scenario.parameters.machine))),
      acceleration_mm_s2_(static_cast<double>(scenario.parameters.machine.cnc.acceleration_mm_s2)),
      teeth_(scenario.cutter.teeth),
      radius_mm_(0.5 * scenario.cutter.diameter_mm) {}

void RunJudge::count_teeth(const CuttingLoad& load) {
    for (std::size_t k = 0; k < teeth_; ++k) {
        broken_[k] = broken_[k] || load.tooth_force_N[k] >= break_N_;
    }
}

void RunJudge::observe(double dt_s, const Motion& motion, const CuttingLoad& load, const TrueEngagement& truth) {
    motion_ = motion;
    const double tooth_N = *std::max_element(load.tooth_force_N.begin(), load.tooth_force_N.end());
    peak_tooth_N_ = std::max(peak_tooth_N_, tooth_N);
    revolution_peak_N_ = std::max(revolution_peak_N_, tooth_N);
    count_teeth(load);
    RunFigures& figures = result_.figures;
    figures.time_s += dt_s;
    figures.path_mm = motion.path_mm;
    figures.peak_tooth_force_N = std::max(figures.peak_tooth_force_N, tooth_N);
    interval_s_ += dt_s;
    interval_angle_rad_ += motion.spindle_speed_rad_s * dt_s;
    torque_sum_ += load.spindle_torque_Nm * dt_s;
    feed_force_sum_ += load.fx_N * dt_s;
    if (truth.cutting) {
        interval_cutting_s_ += dt_s;
        figures.cutting_time_s += dt_s;
        immersion_sum_ += truth.radial_immersion * dt_s;
        depth_sum_ += truth.axial_depth_mm * dt_s;
        override_sum_ += motion.override_ratio * dt_s;
    }
    revolution_rad_ += motion.spindle_speed_rad_s * dt_s;
    revolution_s_ += dt_s;
    if (truth.cutting) {
        section_mm2_ = std::max(section_mm2_, truth.radial_immersion * radius_mm_ * truth.axial_depth_mm);
    }
    if (revolution_rad_ >= turn) {
        close_revolution(truth.cutting);
    }
}

void RunJudge::close_revolution(bool cutting) {
    RunFigures& figures = result_.figures;
    revolutions_[revolution_count_++ % revolutions_.size()] = {revolution_s_, section_mm2_};
    const double reaction_s = latency_s_ + motion_.feed_mm_s / acceleration_mm_s2_ + 2.0 * revolution_s_;
    figures.reaction_time_s = std::max(figures.reaction_time_s, cutting ? reaction_s : 0.0);
    const bool over = revolution_peak_N_ > limit_N_;
    over_since_s_ = over ? over_since_s_ + revolution_s_ : 0.0;
    figures.time_over_limit_s += over ? revolution_s_ : 0.0;
    figures.longest_over_limit_s = std::max(figures.longest_over_limit_s, over_since_s_);
    figures.late_over_limit_s += over && !engagement_has_grown(reaction_s) ? revolution_s_ : 0.0;
    use_sum_ += cutting ? revolution_peak_N_ / limit_N_ * revolution_s_ : 0.0;
    section_mm2_ = 0.0;
    revolution_peak_N_ = 0.0;
    revolution_rad_ = 0.0;
    revolution_s_ = 0.0;
}

/// Whether the chip section grew by more than 1 % from any revolution within that time to a later one.
bool RunJudge::engagement_has_grown(double within_s) const {
    const std::size_t known = std::min(revolution_count_, revolutions_.size());
    double age_s = 0.0;
    double largest_since_mm2 = 0.0;
    for (std::size_t back = 1; back <= known; ++back) {
        const Revolution& past = revolutions_[(revolution_count_ - back) % revolutions_.size()];
        if (largest_since_mm2 > 1.01 * past.section_mm2) {
            return true;
        }
        largest_since_mm2 = std::max(largest_since_mm2, past.section_mm2);
        if (age_s > within_s) {
            return false;
        }
        age_s += past.duration_s;
    }
    return true;  // the run has only begun
}

void RunJudge::follow(double time_s, const hal::FeedOverride& output, const TraceSource& controller,
                      double trace_interval_s) {
    constexpr double stands_mm = 0.05;  // cutting forces shake a machine that stands
    const bool stands = output.fault != 0 && motion_.path_mm - stopped_at_mm_ < stands_mm;
    stopped_at_mm_ = stands ? stopped_at_mm_ : motion_.path_mm;
    stopped_s_ = stands ? stopped_s_ + 1e-3 : 0.0;
    if (output.fault != 0) {
        result_.figures.fault = control::name(static_cast<control::Fault>(output.fault));
    }
    if (interval_s_ >= trace_interval_s && interval_angle_rad_ >= turn) {
        close_interval(time_s, output, controller);
    }
}

void RunJudge::close_interval(double time_s, const hal::FeedOverride& output, const TraceSource& controller) {
    TracePoint point;
    point.time_s = time_s;
    point.path_mm = motion_.path_mm;
    point.x_mm = motion_.position_mm.x();
    point.y_mm = motion_.position_mm.y();
    point.z_mm = motion_.position_mm.z();
    point.feed_mm_s = motion_.feed_mm_s;
    point.programmed_feed_mm_s = motion_.programmed_feed_mm_s;
    point.rapid = motion_.rapid;
    point.true_tooth_force_N = peak_tooth_N_;
    point.true_peak_force_N = peak_total_N_;
    point.true_tangential_force_N = torque_sum_ / interval_s_ * 1000.0 / radius_mm_;
    point.true_feed_force_N = feed_force_sum_ / interval_s_;
    if (interval_cutting_s_ > 0.99 * interval_s_) {
        point.true_radial_immersion = immersion_sum_ / interval_cutting_s_;
        point.true_axial_depth_mm = depth_sum_ / interval_cutting_s_;
    }
    controller.describe(point);
    point.override_ratio = static_cast<double>(output.ratio);
    judge_estimate(point);
    result_.trace.push_back(point);
    interval_s_ = 0.0;
    interval_angle_rad_ = 0.0;
    interval_cutting_s_ = 0.0;
    torque_sum_ = 0.0;
    feed_force_sum_ = 0.0;
    immersion_sum_ = 0.0;
    depth_sum_ = 0.0;
    peak_tooth_N_ = 0.0;
    peak_total_N_ = 0.0;
}

void RunJudge::judge_estimate(const TracePoint& point) {
    if (std::isnan(point.true_radial_immersion)) {
        return;
    }
    ++cutting_samples_;
    tangential_error_.add(point.tangential_force_N, point.true_tangential_force_N);
    feed_force_error_.add(point.feed_force_N, point.true_feed_force_N);
    if (!std::isnan(point.radial_immersion)) {
        const double error = point.radial_immersion - point.true_radial_immersion;
        immersion_error2_ += error * error;
        immersion_inside_ += std::abs(error) <= band * point.radial_immersion_sd ? 1 : 0;
        ++immersion_samples_;
    }
    if (!std::isnan(point.axial_depth_mm)) {
        const double error = point.axial_depth_mm - point.true_axial_depth_mm;
        depth_error2_ += error * error;
        depth_inside_ += std::abs(error) <= band * point.axial_depth_sd_mm ? 1 : 0;
        ++depth_samples_;
    }
}

RunResult RunJudge::result(const std::string& controller, bool finished) const {
    RunResult result = result_;
    result.controller = controller;
    RunFigures& f = result.figures;
    f.finished = finished;
    f.peak_over_limit = f.peak_tooth_force_N / limit_N_;
    f.teeth_broken = static_cast<int>(std::count(broken_.begin(), broken_.end(), true));
    if (f.cutting_time_s > 0.0) {
        f.mean_override = override_sum_ / f.cutting_time_s;
        f.mean_force_use = use_sum_ / f.cutting_time_s;
    }
    const auto rms = [](double sum, int count) { return count > 0 ? std::sqrt(sum / count) : host::no_estimate; };
    const auto share = [](int part, int count) {
        return count > 0 ? static_cast<double>(part) / count : host::no_estimate;
    };
    f.tangential_error = tangential_error_.value();
    f.feed_force_error = feed_force_error_.value();
    f.immersion_rms = rms(immersion_error2_, immersion_samples_);
    f.immersion_coverage = share(immersion_inside_, immersion_samples_);
    f.depth_rms_mm = rms(depth_error2_, depth_samples_);
    f.depth_coverage = share(depth_inside_, depth_samples_);
    f.estimate_share = cutting_samples_ > 0 ? share(immersion_samples_, cutting_samples_) : 0.0;
    f.depth_share = cutting_samples_ > 0 ? share(depth_samples_, cutting_samples_) : 0.0;
    return result;
}

}  // namespace millforce::sim
