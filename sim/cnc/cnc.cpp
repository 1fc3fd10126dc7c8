#include "cnc/cnc.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "files/input_error.hpp"

namespace millforce::sim {

namespace {

constexpr std::size_t blocks_ahead = 256;
constexpr double no_limit = std::numeric_limits<double>::infinity();

/// Sonny Jeon's junction deviation: the speed on the circle that touches both blocks and stays within the deviation.
double junction_speed(const Move& before, const Move& after, double acceleration, double deviation_mm) {
    const Eigen::Vector3d in = direction_at(before, length_mm(before));
    const Eigen::Vector3d out = direction_at(after, 0.0);
    const double cosine = std::clamp(-in.dot(out), -1.0, 1.0);
    const double sine_half = std::sqrt(0.5 * (1.0 - cosine));
    if (sine_half > 1.0 - 1e-9) {
        return no_limit;
    }
    return std::sqrt(acceleration * deviation_mm * sine_half / (1.0 - sine_half));
}

}  // namespace

Cnc::Cnc(const CncSettings& settings, std::vector<Move> moves) : settings_(settings), moves_(std::move(moves)) {
    if (moves_.empty()) {
        throw InputError("part program: no moves, expected at least one");
    }
    const double periods = std::round(settings_.override_latency_s / settings_.servo_period_s);
    override_line_.assign(static_cast<std::size_t>(std::max(0.0, periods)) + 1, 0.0);
    prepare();
    wait_s_ = moves_.front().dwell_s;
}

void Cnc::prepare() {
    for (std::size_t k = 0; k < moves_.size(); ++k) {
        const Move& move = moves_[k];
        Block block{};
        block.length_mm = length_mm(move);
        block.limit_mm_s = move.kind == MoveKind::rapid ? settings_.rapid_feed_mm_s : move.feed_mm_s;
        const bool stops = move.kind == MoveKind::dwell || k + 1 == moves_.size() ||
                           moves_[k + 1].kind == MoveKind::dwell ||
                           std::abs(moves_[k + 1].spindle_speed_rad_s - move.spindle_speed_rad_s) > 1e-9;
        block.junction_mm_s =
            stops ? 0.0
                  : junction_speed(move, moves_[k + 1], settings_.acceleration_mm_s2, settings_.junction_deviation_mm);
        total_mm_ += block.length_mm;
        blocks_.push_back(block);
    }
}

double Cnc::block_limit(std::size_t index, double override_ratio) const {
    const Move& move = moves_[index];
    const double ratio = move.kind == MoveKind::rapid ? std::min(1.0, override_ratio) : override_ratio;
    double limit = blocks_[index].limit_mm_s * ratio;
    if (is_arc(move)) {
        limit = std::min(limit, std::sqrt(settings_.acceleration_mm_s2 * arc_radius_mm(move)));
    }
    return limit;
}

double Cnc::velocity_limit(double override_ratio) const {
    const double a = settings_.acceleration_mm_s2;
    const double a_dt = a * settings_.servo_period_s;
    double limit = block_limit(index_, override_ratio);
    double distance = blocks_[index_].length_mm - along_mm_;
    const double reach = velocity_mm_s_ * velocity_mm_s_ / (2.0 * a) + 2.0 * velocity_mm_s_ * settings_.servo_period_s;
    for (std::size_t k = index_; k < moves_.size(); ++k) {
        const bool last_seen = k - index_ >= blocks_ahead;
        const double next = k + 1 < moves_.size() && !last_seen ? block_limit(k + 1, override_ratio) : 0.0;
        const double through = std::min(blocks_[k].junction_mm_s, next);
        // The discrete form of √(v² + 2 a d): one more period at full speed still leaves room to brake.
        limit = std::min(limit, std::sqrt(a_dt * a_dt + through * through + 2.0 * a * std::max(distance, 0.0)) - a_dt);
        if (distance > reach || last_seen || k + 1 >= moves_.size()) {
            break;
        }
        distance += blocks_[k + 1].length_mm;
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
    if (finished()) {
        velocity_mm_s_ = 0.0;
        return;
    }
    if (wait_s_ > 0.0) {
        wait_s_ -= settings_.servo_period_s;
        velocity_mm_s_ = 0.0;
        if (wait_s_ <= 0.0 && moves_[index_].kind == MoveKind::dwell) {
            ++index_;
        }
        return;
    }
    const double most = settings_.acceleration_mm_s2 * settings_.servo_period_s;
    const double wanted = velocity_limit(ratio);
    velocity_mm_s_ = std::max(0.0, std::clamp(wanted, velocity_mm_s_ - most, velocity_mm_s_ + most));
    // A rounding error short of a stop must not last for ever.
    const double creep = 1e-6;
    advance(std::max(velocity_mm_s_ * settings_.servo_period_s, ratio > 0.0 ? creep : 0.0));
}

void Cnc::advance(double distance_mm) {
    double left = distance_mm;
    while (index_ < moves_.size()) {
        const double rest = blocks_[index_].length_mm - along_mm_;
        if (left < rest) {
            along_mm_ += left;
            path_mm_ += left;
            return;
        }
        path_mm_ += rest;
        left -= rest;
        const bool stops = blocks_[index_].junction_mm_s <= 0.0;
        const double speed_before = moves_[index_].spindle_speed_rad_s;
        ++index_;
        along_mm_ = 0.0;
        if (stops || index_ >= moves_.size()) {
            velocity_mm_s_ = 0.0;
            if (index_ < moves_.size()) {
                const bool other_speed = std::abs(moves_[index_].spindle_speed_rad_s - speed_before) > 1e-9;
                wait_s_ = std::max(moves_[index_].dwell_s, other_speed ? settings_.spindle_wait_s : 0.0);
            }
            return;
        }
    }
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

bool Cnc::is_rapid() const { return !finished() && move().kind == MoveKind::rapid; }

double Cnc::spindle_speed_rad_s() const { return move().spindle_speed_rad_s; }

std::size_t Cnc::line() const { return move().line; }

}  // namespace millforce::sim
