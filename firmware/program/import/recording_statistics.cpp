// SPDX-License-Identifier: Apache-2.0
#include "import/recording_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace millforce::host {

namespace {

constexpr std::size_t steps_for_median = 255;
constexpr double gap_steps = 1.5;

}  // namespace

void StepStatistics::add(double time_s) {
    if (rows_ == 0) {
        first_s_ = time_s;
    } else if (std::isnan(median_s_)) {
        first_steps_.push_back({time_s - last_s_, last_s_});
        if (first_steps_.size() == steps_for_median) {
            settle_median();
        }
    } else {
        judge({time_s - last_s_, last_s_});
    }
    last_s_ = time_s;
    ++rows_;
}

void StepStatistics::finish() {
    if (std::isnan(median_s_) && !first_steps_.empty()) {
        settle_median();
    }
}

void StepStatistics::settle_median() {
    std::vector<Step> sorted = first_steps_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end(),
                     [](const Step& a, const Step& b) { return a.length_s < b.length_s; });
    median_s_ = middle->length_s;
    for (const Step& step : first_steps_) {
        judge(step);
    }
    first_steps_.clear();
}

void StepStatistics::judge(const Step& step) {
    if (step.length_s > gap_steps * median_s_) {
        ++gaps_;
        if (step.length_s > longest_gap_s_) {
            longest_gap_s_ = step.length_s;
            longest_gap_at_s_ = step.begin_s;
        }
        return;
    }
    ++regular_steps_;
    const double difference_s = step.length_s - median_s_;
    sum_s_ += difference_s;
    sum_s2_ += difference_s * difference_s;
}

double StepStatistics::rate_hz() const {
    const auto count = static_cast<double>(regular_steps_);
    return regular_steps_ > 0 ? 1.0 / (median_s_ + sum_s_ / count) : std::numeric_limits<double>::quiet_NaN();
}

double StepStatistics::unevenness() const {
    if (regular_steps_ == 0) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const auto count = static_cast<double>(regular_steps_);
    const double mean_s = sum_s_ / count;
    return std::sqrt(std::max(0.0, sum_s2_ / count - mean_s * mean_s)) * rate_hz();
}

void Sparkline::double_pieces() {
    for (std::size_t k = 0; k < width; ++k) {
        const bool has_pair = 2 * k + 1 < width;
        pieces_[k] = has_pair ? Piece{pieces_[2 * k].sum + pieces_[2 * k + 1].sum,
                                      pieces_[2 * k].count + pieces_[2 * k + 1].count}
                              : Piece{};
    }
    piece_s_ *= 2.0;
    used_ = (used_ + 1) / 2;
}

void Sparkline::add(double time_s, double value) {
    while (time_s >= piece_s_ * static_cast<double>(width)) {
        double_pieces();
    }
    const auto place = static_cast<std::size_t>(std::max(0.0, time_s / piece_s_));
    used_ = std::max(used_, place + 1);
    if (!std::isnan(value)) {
        pieces_[place].sum += value;
        ++pieces_[place].count;
    }
}

std::string Sparkline::text() const {
    constexpr std::array<std::string_view, 8> bars{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Piece& piece : pieces_) {
        if (piece.count > 0) {
            const double mean = piece.sum / static_cast<double>(piece.count);
            low = std::min(low, mean);
            high = std::max(high, mean);
        }
    }
    constexpr double rounding = 1e-9;
    const bool is_constant = high - low <= rounding * std::max(std::abs(low), std::abs(high));
    std::string text;
    for (std::size_t k = 0; k < used_; ++k) {
        const Piece& piece = pieces_[k];
        if (piece.count == 0) {
            text += ' ';
            continue;
        }
        constexpr auto top = static_cast<double>(bars.size() - 1);
        const double level = (piece.sum / static_cast<double>(piece.count) - low) / (high - low) * (top + 1.0);
        text += bars[is_constant ? 0 : level >= top ? bars.size() - 1 : static_cast<std::size_t>(level)];
    }
    return text;
}

void ColumnStatistics::add(double time_s, double value) {
    sparkline_.add(time_s, value);
    if (std::isnan(value)) {
        ++missing_;
        return;
    }
    ++count_;
    mean_ += (value - mean_) / static_cast<double>(count_);
    minimum_ = count_ == 1 ? value : std::min(minimum_, value);
    maximum_ = count_ == 1 ? value : std::max(maximum_, value);
    first_ = count_ == 1 ? value : first_;
    if (count_ > 1 && value < last_) {
        ++falls_;
        largest_fall_ = std::max(largest_fall_, last_ - value);
    }
    last_ = value;
}

double ColumnStatistics::mean() const {
    return count_ > 0 ? mean_ : none;
}

double ColumnStatistics::largest_magnitude() const {
    return std::max(std::abs(minimum_), std::abs(maximum_));
}

}  // namespace millforce::host
