// SPDX-License-Identifier: Apache-2.0
#include "commission/idle_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimation/number/least_squares.hpp"

namespace millforce::host {

namespace {

constexpr double rpm_per_rad_s = 30.0 / std::numbers::pi;

bool is_same_speed(double a_rad_s, double b_rad_s) {
    return std::abs(a_rad_s - b_rad_s) <= 0.05 * std::max(std::abs(a_rad_s), std::abs(b_rad_s));
}

bool do_axes_rest(const RevolutionBlock& block) {
    return std::all_of(block.velocity_mm_s.begin(), block.velocity_mm_s.end(),
                       [](double velocity) { return std::abs(velocity) < 0.5; });
}

}  // namespace

IdleWatch::IdleWatch(std::uint32_t counts_per_rev, std::size_t speeds, double dwell_s)
    : blocks_(counts_per_rev), speeds_(speeds), dwell_s_(dwell_s) {}

void IdleWatch::add(const TimedSample& timed) {
    if (const auto block = blocks_.add(timed)) {
        take_block(*block);
    }
}

void IdleWatch::take_block(const RevolutionBlock& block) {
    constexpr double steady = 0.01;
    const bool goes_on =
        now_.blocks > 0 && std::abs(block.spindle_rad_s - now_.spindle_rad_s) < steady * std::abs(now_.spindle_rad_s);
    if (!goes_on || !do_axes_rest(block)) {
        end_plateau();
        if (do_axes_rest(block) && std::abs(block.spindle_rad_s) > 1.0) {
            now_ = {block.spindle_rad_s, 0.0, 0.0, 0.0, 1};  // its own current may be that of the start
        }
        return;
    }
    const bool was_long = now_.duration_s >= dwell_s_;
    const auto n = static_cast<double>(now_.blocks);  // without the first one
    now_.current_A += (block.spindle_current_A - now_.current_A) / n;
    now_.noise_A += (block.current_noise_A - now_.noise_A) / n;
    now_.duration_s += block.end_s - block.start_s;
    ++now_.blocks;
    if (!was_long && now_.duration_s >= dwell_s_) {
        tell(fmt::format("  {:.0f} 1/min: idles at {:.3f} A", now_.spindle_rad_s * rpm_per_rad_s, now_.current_A));
        if (const auto so_far = fit()) {
            tell(fmt::format("  fit of {} speeds: {:.4f} ± {:.4f} A + ({:.3g} ± {:.2g}) A·s/rad × speed",
                             plateaus().size(), so_far->offset_A, so_far->offset_se, so_far->slope_A_s,
                             so_far->slope_se));
        }
    }
}

void IdleWatch::end() {
    end_plateau();
    blocks_.reset();
}

void IdleWatch::end_plateau() {
    if (now_.duration_s >= dwell_s_) {
        found_.push_back(now_);
    }
    now_ = {};
}

std::vector<IdlePlateau> IdleWatch::plateaus() const {
    std::vector<IdlePlateau> all;
    const auto take_new = [&](const IdlePlateau& plateau) {
        const bool is_known = std::any_of(all.begin(), all.end(), [&](const IdlePlateau& other) {
            return is_same_speed(other.spindle_rad_s, plateau.spindle_rad_s);
        });
        if (!is_known && plateau.duration_s >= dwell_s_) {
            all.push_back(plateau);
        }
    };
    std::for_each(found_.begin(), found_.end(), take_new);
    take_new(now_);
    return all;
}

bool IdleWatch::is_enough() const {
    return plateaus().size() >= speeds_;
}

std::string IdleWatch::lacks() const {
    const std::size_t count = plateaus().size();
    return count >= speeds_ ? ""
                            : fmt::format("{} of {} speeds, each for {:g} s with the axes at rest", speeds_ - count,
                                          speeds_, dwell_s_);
}

std::optional<IdleFit> IdleWatch::fit() const {
    const std::vector<IdlePlateau> all = plateaus();
    if (all.size() < 3) {
        return std::nullopt;
    }
    estimation::LeastSquares<double, 2> squares;
    IdleFit result;
    for (const IdlePlateau& plateau : all) {
        squares.add({1.0, plateau.spindle_rad_s}, plateau.current_A);
        result.noise_A += plateau.noise_A / static_cast<double>(all.size());
    }
    const auto solution = squares.solve();
    result.offset_A = solution.parameters(0);
    result.offset_se = solution.standard_error(0);
    result.slope_A_s = solution.parameters(1);
    result.slope_se = solution.standard_error(1);
    result.residual_A = solution.residual_rms;
    return result;
}

}  // namespace millforce::host
