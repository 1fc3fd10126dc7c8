// SPDX-License-Identifier: Apache-2.0
#include "cnc/cnc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/input_error.hpp"

namespace millforce::sim {

namespace {

constexpr int feed_changes_ahead = 256;
constexpr double arrived_mm = 1e-9;

void require(const char* name, double value, double least, double most) {
    if (!(value >= least && value <= most)) {
        throw host::InputError(fmt::format("cnc.{}: {}, expected {} to {}", name, value, least, most));
    }
}

const CncSettings& validated(const CncSettings& settings) {
    require("servo_period_s", settings.servo_period_s, 1e-6, 0.1);
    require("acceleration_mm_s2", settings.acceleration_mm_s2, 1.0, 1e6);
    require("override_latency_s", settings.override_latency_s, 0.0, 10.0);
    require("rapid_feed_mm_s", settings.rapid_feed_mm_s, 0.1, 1e5);
    require("junction_deviation_mm", settings.junction_deviation_mm, 1e-6, 10.0);
    require("spindle_wait_s", settings.spindle_wait_s, 0.0, 60.0);
    return settings;
}

std::vector<Move> validated(std::vector<Move> moves) {
    if (moves.empty()) {
        throw host::InputError("part program: no moves, expected at least one");
    }
    return moves;
}

}  // namespace

Cnc::Cnc(const CncSettings& settings, std::vector<Move> moves)
    : settings_(validated(settings)),
      moves_(validated(std::move(moves))),
      limits_(settings_, moves_),
      velocity_step_mm_s_(settings_.acceleration_mm_s2 * settings_.servo_period_s) {
    const double periods = std::round(settings_.override_latency_s / settings_.servo_period_s);
    override_line_.assign(static_cast<std::size_t>(periods) + 1, 0.0);
    wait(moves_.front().dwell_s);
}

double Cnc::feed_limit(std::size_t index, double override_ratio) const {
    const Move& move = moves_[index];
    const double wanted = move.kind == MoveKind::rapid ? settings_.rapid_feed_mm_s * std::min(1.0, override_ratio)
                                                       : move.feed_mm_s * override_ratio;
    return std::min(wanted, limits_[index].most_mm_s);
}

// The largest velocity of this period from which full braking meets a limit that begins at a distance: either slow
// enough already, or √(v_l² + 2 a d) is kept at the period's end. The last way to a stop is gone in one period, and
// only from a velocity that may end in the same period.
double Cnc::approach(double limit_mm_s, double distance_mm) const {
    const double step = velocity_step_mm_s_;
    const double room = limit_mm_s * limit_mm_s + 2.0 * settings_.acceleration_mm_s2 * distance_mm;
    const double braking = room / (std::sqrt(step * step + room) + step);
    if (limit_mm_s > 0.0 || velocity_mm_s_ > step) {
        return std::max(limit_mm_s, braking);
    }
    return std::max(braking, std::min(step, distance_mm / settings_.servo_period_s));
}

double Cnc::limit_by_geometry(double limit_mm_s) const {
    double limit = limit_mm_s;
    double distance = limits_[index_].length_mm - along_mm_;
    for (std::size_t k = index_; k < limits_.size(); ++k) {
        if (k != index_) {
            distance += limits_[k].length_mm;
        }
        limit = std::min(limit, approach(limits_[k].exit_mm_s, distance));
        if (limits_[k].exit_mm_s <= 0.0 || limit * settings_.servo_period_s <= distance) {
            break;  // the period ends in this block, and its exit speaks for all that follows
        }
    }
    return limit;
}

double Cnc::limit_by_feeds(double limit_mm_s, double override_ratio) const {
    double limit = limit_mm_s;
    const double here = limits_[index_].end_mm - (limits_[index_].length_mm - along_mm_);
    std::size_t next = limits_[index_].next_feed;
    for (int changes = 0; next < limits_.size(); ++changes) {
        const double distance = std::max(0.0, limits_[next - 1].end_mm - here);
        if (approach(0.0, distance) >= limit) {
            break;
        }
        if (changes == feed_changes_ahead) {
            return std::min(limit, approach(0.0, distance));
        }
        limit = std::min(limit, approach(feed_limit(next, override_ratio), distance));
        next = limits_[next].next_feed;
    }
    return limit;
}

double Cnc::delayed(double override_ratio) {
    override_line_[override_place_] = override_ratio;
    override_place_ = (override_place_ + 1) % override_line_.size();
    return override_line_[override_place_];
}

void Cnc::step(double override_ratio, bool feed_hold) {
    const bool usable = std::isfinite(override_ratio) && override_ratio > 0.0 && !feed_hold;
    const double ratio = delayed(usable ? override_ratio : 0.0);
    if (finished() || wait_periods_ > 0) {
        velocity_mm_s_ = 0.0;
        if (wait_periods_ > 0 && --wait_periods_ == 0 && move().kind == MoveKind::dwell) {
            enter_next_block();
        }
        return;
    }
    const double least = std::max(0.0, velocity_mm_s_ - velocity_step_mm_s_);
    const double most = std::min(velocity_mm_s_ + velocity_step_mm_s_, feed_limit(index_, ratio));
    velocity_mm_s_ = std::max(least, limit_by_feeds(limit_by_geometry(most), ratio));
    advance(velocity_mm_s_ * settings_.servo_period_s);
}

void Cnc::advance(double distance_mm) {
    double left = distance_mm;
    while (!finished()) {
        const PathLimits::Block& block = limits_[index_];
        const bool stops = block.exit_mm_s <= 0.0;
        const double rest = block.length_mm - along_mm_;
        if (left < rest - (stops ? arrived_mm : 0.0)) {
            along_mm_ += left;
            path_mm_ = block.end_mm - block.length_mm + along_mm_;
            return;
        }
        path_mm_ = block.end_mm;
        left -= rest;
        enter_next_block();
        if (stops) {
            velocity_mm_s_ = 0.0;
            return;
        }
    }
}

void Cnc::enter_next_block() {
    const double speed_before = moves_[index_].spindle_speed_rad_s;
    ++index_;
    along_mm_ = 0.0;
    if (!finished()) {
        const bool other_speed = move().spindle_speed_rad_s != speed_before;
        wait(std::max(move().dwell_s, other_speed ? settings_.spindle_wait_s : 0.0));
    }
}

void Cnc::wait(double time_s) {
    wait_periods_ = std::lround(std::ceil(time_s / settings_.servo_period_s - 1e-6));
}

Eigen::Vector3d Cnc::position_mm() const {
    return finished() ? moves_.back().end_mm : position_at(moves_[index_], along_mm_);
}

Eigen::Vector3d Cnc::direction() const {
    return finished() ? Eigen::Vector3d::Zero().eval() : direction_at(moves_[index_], along_mm_);
}

double Cnc::programmed_feed_mm_s() const {
    return is_rapid() ? settings_.rapid_feed_mm_s : move().feed_mm_s;
}

bool Cnc::is_rapid() const {
    return !finished() && move().kind == MoveKind::rapid;
}

double Cnc::spindle_speed_rad_s() const {
    return move().spindle_speed_rad_s;
}

std::size_t Cnc::line() const {
    return move().line;
}

double Cnc::distance_to_go_mm() const {
    return finished() ? 0.0 : length_mm(move()) - along_mm_;
}

}  // namespace millforce::sim
