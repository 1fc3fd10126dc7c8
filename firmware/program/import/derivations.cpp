// SPDX-License-Identifier: Apache-2.0
#include "import/derivations.hpp"

#include <cmath>

#include "estimation/number/circle.hpp"

namespace millforce::host {

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void PositionSlope::add(const Sample& sample, std::deque<Sample>& out) {
    samples_.push_back(sample);
    while (next_ < samples_.size() && samples_[next_].time_s + half_s_ <= sample.time_s) {
        give(out);
    }
}

void PositionSlope::finish(std::deque<Sample>& out) {
    while (next_ < samples_.size()) {
        give(out);
    }
}

void PositionSlope::give(std::deque<Sample>& out) {
    out.push_back({samples_[next_].time_s, slope()});
    ++next_;
    while (next_ > 0 && next_ < samples_.size() && samples_.front().time_s < samples_[next_].time_s - half_s_) {
        samples_.pop_front();
        --next_;
    }
}

double PositionSlope::slope() const {
    const double middle_s = samples_[next_].time_s;
    std::size_t reach = 0;
    while (next_ >= reach + 1 && next_ + reach + 1 < samples_.size()) {
        const Sample& before = samples_[next_ - reach - 1];
        const Sample& after = samples_[next_ + reach + 1];
        const bool is_within = before.time_s >= middle_s - half_s_ && after.time_s <= middle_s + half_s_;
        if (!is_within || std::isnan(before.value) || std::isnan(after.value)) {
            break;
        }
        ++reach;
    }
    if (reach == 0 || std::isnan(samples_[next_].value)) {
        return no_value;
    }
    const Sample& first = samples_[next_ - reach];
    const Sample& last = samples_[next_ + reach];
    return (last.value - first.value) / (last.time_s - first.time_s);
}

double PositionSlope::waits_since_s() const {
    return next_ < samples_.size() ? samples_[next_].time_s : std::numeric_limits<double>::infinity();
}

void SpeedIntegral::add(const Sample& sample, std::deque<Sample>& out) {
    if (std::isnan(sample.value)) {
        out.push_back({sample.time_s, no_value});
        return;
    }
    if (!std::isnan(last_.value)) {
        angle_rad_ += 0.5 * (last_.value + sample.value) * (sample.time_s - last_.time_s);
    }
    last_ = sample;
    out.push_back({sample.time_s, angle_rad_});
}

void IndexAngle::add(const Sample& sample, std::deque<Sample>& out) {
    if (!std::isnan(sample.value)) {
        const bool is_high = sample.value > threshold_;
        if (is_high && !is_high_) {
            end_turn(sample.time_s, out);
        }
        is_high_ = is_high;
    }
    waiting_s_.push_back(sample.time_s);
    while (waiting_s_.front() < sample.time_s - longest_turn_s) {
        out.push_back({waiting_s_.front(), no_value});
        waiting_s_.pop_front();
    }
}

void IndexAngle::end_turn(double edge_s, std::deque<Sample>& out) {
    const bool is_turn = edge_s - edge_s_ <= longest_turn_s;
    for (const double time_s : waiting_s_) {
        const double share = (time_s - edge_s_) / (edge_s - edge_s_);
        const bool is_known = is_turn && share >= 0.0;
        out.push_back(
            {time_s, is_known ? estimation::turn_rad<double> * (static_cast<double>(turns_) + share) : no_value});
    }
    waiting_s_.clear();
    turns_ += std::isnan(edge_s_) ? 0U : 1U;
    edge_s_ = edge_s;
}

void IndexAngle::finish(std::deque<Sample>& out) {
    for (const double time_s : waiting_s_) {
        out.push_back({time_s, no_value});
    }
    waiting_s_.clear();
}

double IndexAngle::waits_since_s() const {
    return waiting_s_.empty() ? std::numeric_limits<double>::infinity() : waiting_s_.front();
}

bool Unwrap::follow(double& value) {
    if (std::isnan(value)) {
        return true;
    }
    if (!std::isnan(last_)) {
        const double step = value - last_;
        if (std::abs(step) > wrap_) {
            return false;
        }
        whole_ += step > 0.5 * wrap_ ? -wrap_ : step < -0.5 * wrap_ ? wrap_ : 0.0;
    }
    last_ = value;
    value += whole_;
    return true;
}

}  // namespace millforce::host
