// SPDX-License-Identifier: Apache-2.0
#include "check/order_spectrum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "estimation/number/circle.hpp"

namespace millforce::host {

namespace {

constexpr double turn_rad = estimation::turn_rad<double>;
constexpr double revolutions = OrderBlock::per_order;
constexpr double fewest_samples_per_period = 2.5;
constexpr double highest_useful_order = 26.0;
constexpr double largest_gap_rev = 0.5;
constexpr int beyond_last_order = OrderBlock::per_order / 2 + 1;  // places

/// Values less the straight line through them.
std::vector<double> without_line(std::vector<double> values) {
    const auto n = static_cast<double>(values.size());
    const double middle = 0.5 * (n - 1.0);
    double sum = 0.0;
    double moment = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        sum += values[k];
        moment += (static_cast<double>(k) - middle) * values[k];
    }
    const double slope = 12.0 * moment / (n * (n * n - 1.0));
    for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] -= sum / n + slope * (static_cast<double>(k) - middle);
    }
    return values;
}

}  // namespace

void OrderBlocks::add(double time_s, double turned_rev, double value) {
    if (!(turned_rev >= 0.0 && turned_rev < largest_gap_rev)) {
        samples_.clear();
    }
    const double angle_rev = samples_.empty() ? 0.0 : samples_.back().angle_rev + turned_rev;
    samples_.push_back({time_s, angle_rev, value});
    // A spindle that stands must not fill the memory.
    constexpr double longest_s = 4.0;
    if (angle_rev >= revolutions) {
        close();
    } else if (time_s - samples_.front().time_s > longest_s) {
        samples_.clear();
    }
}

void OrderBlocks::close() {
    const auto count = static_cast<double>(samples_.size());
    OrderBlock block;
    block.start_s = samples_.front().time_s;
    block.end_s = samples_.back().time_s;
    block.samples_per_rev = count / revolutions;
    const auto orders =
        static_cast<std::size_t>(std::min(highest_useful_order, block.samples_per_rev / fewest_samples_per_period));
    std::vector<double> values;
    for (const Sample& sample : samples_) {
        values.push_back(sample.value);
    }
    values = without_line(std::move(values));
    block.power.assign(orders * OrderBlock::per_order + beyond_last_order, 0.0);
    std::vector<std::complex<double>> sums(block.power.size());
    for (std::size_t k = 0; k < samples_.size(); ++k) {
        const double share = samples_[k].angle_rev / revolutions;
        const double weighted = values[k] * (0.5 - 0.5 * std::cos(turn_rad * share)) / count;
        const std::complex<double> step = std::polar(1.0, -turn_rad * share);
        std::complex<double> turning = weighted;
        for (std::complex<double>& sum : sums) {
            sum += turning;
            turning *= step;
        }
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
        block.power[k] = std::norm(sums[k]);
    }
    blocks_.push_back(std::move(block));
    samples_.clear();
}

void OrderSpectrum::add(const OrderBlock& block) {
    sum_.resize(blocks_ == 0 ? block.power.size() : std::min(sum_.size(), block.power.size()));
    for (std::size_t k = 0; k < sum_.size(); ++k) {
        sum_[k] += block.power[k];
    }
    ++blocks_;
}

int OrderSpectrum::highest_order() const {
    return std::max(0, static_cast<int>(sum_.size()) - beyond_last_order) / OrderBlock::per_order;
}

double OrderSpectrum::power(std::size_t place) const {
    return place < sum_.size() ? sum_[place] / static_cast<double>(blocks_) : 0.0;
}

/// The Hann window spreads a line over one place to each side; the places around that are noise, unless there is
/// another line.
double OrderSpectrum::surroundings(std::size_t place) const {
    std::array<double, 6> around{};
    std::size_t count = 0;
    for (const std::size_t distance : {2U, 3U, 4U}) {
        if (place >= distance + 2) {  // below lies what the straight line left
            around.at(count++) = power(place - distance);
        }
        if (place + distance < sum_.size()) {
            around.at(count++) = power(place + distance);
        }
    }
    const auto middle = around.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(around.begin(), middle, around.begin() + static_cast<std::ptrdiff_t>(count));
    return count > 0 ? *middle : 0.0;
}

double OrderSpectrum::line(std::size_t place) const {
    constexpr double deviations = 8.0;
    if (blocks_ < fewest_blocks || place >= sum_.size()) {
        return 0.0;
    }
    const double noise = surroundings(place);
    const double least = noise * (1.0 + deviations / std::sqrt(static_cast<double>(blocks_)));
    return power(place) > least ? power(place) - noise : 0.0;
}

}  // namespace millforce::host
