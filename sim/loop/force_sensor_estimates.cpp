#include "loop/force_sensor_estimates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace millforce::sim {

namespace {

constexpr double whole_turn_rad = 2.0 * std::numbers::pi;
constexpr float degree_rad = std::numbers::pi_v<float> / 180.0F;

/// −π…π
double wrapped_rad(double angle_rad) {
    return std::remainder(angle_rad, whole_turn_rad);
}

estimation::CutSide side_of(const firmware::ToolParameters<float>& tool) {
    return static_cast<estimation::CutSide>(static_cast<unsigned char>(tool.side));
}

estimation::ForceDropLaw<float> law_of(const firmware::ToolParameters<float>& tool) {
    estimation::ForceDropLaw<float> law = tool.force_drop.law;
    law.valid = true;
    // The file holds the upper triangles.
    law.a_b_covariance(1, 0) = law.a_b_covariance(0, 1);
    law.c_covariance(1, 0) = law.c_covariance(0, 1);
    law.c_covariance(2, 0) = law.c_covariance(0, 2);
    law.c_covariance(2, 1) = law.c_covariance(1, 2);
    return law;
}

estimation::ForceDropSettings<float> force_drop_settings_of(const firmware::ToolParameters<float>& tool) {
    estimation::ForceDropSettings<float> settings;
    settings.detector.teeth = static_cast<int>(tool.teeth);
    settings.detector.response.corner_hz = tool.force_sensor.low_pass_hz;
    settings.revolutions = static_cast<int>(tool.force_drop.revolutions);
    settings.side = side_of(tool);
    settings.zero_drift_sd_N = tool.force_sensor.zero_drift_sd_N;
    return settings;
}

/// Depths to 55 % on either side of the nominal ones, so that a variation of 50 % is not at the end of the search.
estimation::DepthRange<float> range_about(float nominal_mm, float largest_mm) {
    constexpr float reach = 0.55F;
    return {(1.0F - reach) * nominal_mm, std::min((1.0F + reach) * nominal_mm, largest_mm)};
}

estimation::FluteProfileFitSettings<float> profile_settings_of(const firmware::ToolParameters<float>& tool) {
    const firmware::DepthShapeParameters<float>& shape = tool.depth_shape;
    estimation::FluteProfileFitSettings<float> settings;
    settings.cutter = {static_cast<int>(tool.teeth), 0.5F * tool.diameter_mm, tool.helix_deg * degree_rad};
    settings.feed_per_tooth_mm = shape.feed_per_tooth_mm;
    settings.side = side_of(tool);
    settings.axial = range_about(shape.nominal_axial_depth_mm, tool.flute_length_mm);
    settings.radial = range_about(shape.nominal_radial_width_mm, tool.diameter_mm);
    if (tool.force_sensor.low_pass_hz > 0.0F) {
        settings.low_pass = {2, tool.force_sensor.low_pass_hz};
    }
    const float sd_rad = shape.tip_angle_sd_deg * degree_rad;
    settings.tip_angle_rad = {sd_rad > 0.0F, shape.tip_angle_deg * degree_rad, sd_rad * sd_rad, sd_rad * sd_rad};
    return settings;
}

}  // namespace

/// φ grows from the frame's +y to its +x; a frame turned by the feed's direction counter-clockwise sees each tooth that
/// much further on.
FeedFrame::Turned FeedFrame::turn(const ForceSensorSample& sample) {
    constexpr double slowest_mm_s = 0.1;
    constexpr double widest_rad = 3.0 * std::numbers::pi / 180.0;
    const double speed_mm_s = std::hypot(sample.x_velocity_mm_s, sample.y_velocity_mm_s);
    const bool is_there = std::isfinite(sample.spindle_angle_rad) && std::isfinite(sample.fx_N) &&
                          std::isfinite(sample.fy_N) && speed_mm_s >= slowest_mm_s;
    if (!is_there) {
        has_direction_ = false;
        return {};
    }
    const double direction_rad = std::atan2(sample.y_velocity_mm_s, sample.x_velocity_mm_s);
    const bool is_new = !has_direction_ || std::abs(wrapped_rad(direction_rad - direction_rad_)) > widest_rad;
    direction_rad_ = is_new ? direction_rad : direction_rad_;
    has_direction_ = true;
    const double cosine = std::cos(direction_rad_);
    const double sine = std::sin(direction_rad_);
    const double angle_rev = (sample.spindle_angle_rad + direction_rad_) / whole_turn_rad;
    return {true, is_new, static_cast<float>(angle_rev - std::floor(angle_rev)),
            static_cast<float>(cosine * sample.fx_N + sine * sample.fy_N),
            static_cast<float>(cosine * sample.fy_N - sine * sample.fx_N)};
}

ForceSensorEstimates::ForceSensorEstimates(const firmware::Parameters<float>& parameters) : tool_(parameters.tool) {
    make_force_drop();
    make_depth_monitor();
}

void ForceSensorEstimates::make_force_drop() {
    if (!(tool_.force_drop.law.largest_immersion > 0.0F)) {
        missing_.emplace_back("no immersion from force drops: the tool has no calibrated [force_drop] table");
    } else if (!(tool_.force_sensor.low_pass_hz > 0.0F)) {
        missing_.emplace_back("no immersion from force drops: the tool's [force_sensor] table has no low_pass_hz");
    } else {
        force_drop_.emplace(law_of(tool_), force_drop_settings_of(tool_));
    }
}

void ForceSensorEstimates::make_depth_monitor() {
    const firmware::DepthShapeParameters<float>& shape = tool_.depth_shape;
    if (!(shape.nominal_axial_depth_mm > 0.0F) || !(shape.nominal_radial_width_mm > 0.0F)) {
        missing_.emplace_back(
            "no depths from the force's shape: the tool's [depth_shape] table has no nominal_axial_depth_mm or no "
            "nominal_radial_width_mm");
    } else if (tool_.helix_deg < 5.0F || side_of(tool_) == estimation::CutSide::centred) {
        missing_.emplace_back(
            "no depths from the force's shape: it takes a helix of at least 5° and a wall to one side");
    } else {
        depths_.emplace(profile_settings_of(tool_), static_cast<int>(shape.revolutions));
    }
}

void ForceSensorEstimates::restart() {
    estimate_ = {};
    force_drop_travel_ = {};
    depth_travel_ = {};
    if (force_drop_) {
        force_drop_->restart();
    }
    if (depths_) {
        depths_->restart();
    }
}

void ForceSensorEstimates::add(const ForceSensorSample& sample) {
    const FeedFrame::Turned turned = frame_.turn(sample);
    if (!turned.valid || turned.is_new) {
        restart();
    }
    if (!turned.valid) {
        return;
    }
    follow(sample, turned);
    const auto dt_s = static_cast<float>(turned.is_new ? 0.0 : sample.time_s - last_time_s_);
    last_time_s_ = sample.time_s;
    last_angle_rev_ = turned.spindle_angle_rev;
    add_force_drop(turned, dt_s);
    add_depths(turned, dt_s);
    drop_outdated();
}

void ForceSensorEstimates::follow(const ForceSensorSample& sample, const FeedFrame::Turned& turned) {
    if (turned.is_new) {
        return;
    }
    const double step_rev = static_cast<double>(turned.spindle_angle_rev - last_angle_rev_);
    const double speed_mm_s = std::hypot(sample.x_velocity_mm_s, sample.y_velocity_mm_s);
    for (Travel* travel : {&force_drop_travel_, &depth_travel_}) {
        travel->path_mm += speed_mm_s * (sample.time_s - last_time_s_);
        travel->turned_rev += step_rev - std::floor(step_rev + 0.5);
    }
}

void ForceSensorEstimates::add_force_drop(const FeedFrame::Turned& turned, float dt_s) {
    if (!force_drop_) {
        return;
    }
    const Travel& travel = force_drop_travel_;
    const double teeth_passed = travel.turned_rev * static_cast<double>(tool_.teeth);
    const auto feed_per_tooth_mm = static_cast<float>(teeth_passed > 0.0 ? travel.path_mm / teeth_passed : 0.0);
    if (!force_drop_->add({turned.spindle_angle_rev, dt_s, turned.along_N, turned.across_N}, feed_per_tooth_mm)) {
        return;
    }
    const auto& made = force_drop_->estimate();
    const float variance = made.radial_immersion_sd * made.radial_immersion_sd;
    estimate_.force_drop_immersion = {made.valid(), made.radial_immersion, variance, variance};
    ++force_drop_count_.due;
    force_drop_count_.valid += made.valid() ? 1 : 0;
    force_drop_travel_ = {};
}

void ForceSensorEstimates::add_depths(const FeedFrame::Turned& turned, float dt_s) {
    constexpr float turn_rad = 2.0F * std::numbers::pi_v<float>;
    if (!depths_ || !depths_->add(dt_s, turned.spindle_angle_rev * turn_rad, turned.along_N, turned.across_N)) {
        return;
    }
    const auto made = depths_->evaluate();
    estimate_.axial_depth_mm = made.axial_depth_mm;
    estimate_.radial_width_mm = made.radial_depth_mm;
    ++depth_count_.due;
    depth_count_.valid += made.axial_depth_mm.valid || made.radial_depth_mm.valid ? 1 : 0;
    depth_travel_ = {};
}

/// An estimate is followed by the next one as soon as the spindle has turned on as far; one that is not has been
/// overtaken: samples are missing, or the spindle stands.
void ForceSensorEstimates::drop_outdated() {
    constexpr double late = 2.0;
    if (std::abs(force_drop_travel_.turned_rev) > late * static_cast<double>(tool_.force_drop.revolutions)) {
        estimate_.force_drop_immersion.valid = false;
    }
    if (std::abs(depth_travel_.turned_rev) > late * static_cast<double>(tool_.depth_shape.revolutions)) {
        estimate_.axial_depth_mm.valid = false;
        estimate_.radial_width_mm.valid = false;
    }
}

std::string ForceSensorEstimates::summary() const {
    std::string text;
    if (force_drop_) {
        text += fmt::format("immersion from force drops: {} estimates of {} that were due\n", force_drop_count_.valid,
                            force_drop_count_.due);
    }
    if (depths_) {
        text += fmt::format("depths from the force's shape: {} estimates of {} that were due\n", depth_count_.valid,
                            depth_count_.due);
    }
    return text;
}

}  // namespace millforce::sim
