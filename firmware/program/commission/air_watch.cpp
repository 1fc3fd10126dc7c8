// SPDX-License-Identifier: Apache-2.0
#include "commission/air_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation_calibration/friction_fit.hpp"

namespace millforce::host {

namespace {

constexpr double slowest_mm_s = 0.5;
constexpr double feed_tolerance = 0.05;
constexpr double mm_min_per_m_min = 1000.0;

char axis_letter(std::size_t axis) {
    return "xyz"[axis];
}

}  // namespace

AirWatch::AirWatch(std::vector<std::size_t> axes, std::vector<double> feeds_m_per_min)
    : axes_(std::move(axes)),
      feeds_m_per_min_(std::move(feeds_m_per_min)),
      finders_{SteadyFeedFinder(slowest_mm_s), SteadyFeedFinder(slowest_mm_s), SteadyFeedFinder(slowest_mm_s)} {}

void AirWatch::add(const TimedSample& timed) {
    for (const std::size_t axis : axes_) {
        add_axis(axis, timed);
    }
}

void AirWatch::add_axis(std::size_t axis, const TimedSample& timed) {
    SteadyFeedFinder& finder = finders_.at(axis);
    const std::size_t before = finder.found().size();
    if ((timed.sample.present & hal::axis_mask(axis)) == 0) {
        finder.close();
        noise_.at(axis).last_A.reset();
    } else {
        const auto velocity = static_cast<double>(timed.sample.axis_velocity_mm_s.at(axis));
        const auto current = static_cast<double>(timed.sample.axis_current_A.at(axis));
        finder.add(timed.time_s, velocity, current);
        add_noise(noise_.at(axis), std::abs(velocity) > slowest_mm_s, current);
    }
    if (finder.found().size() > before) {
        show_fit(axis);
    }
}

/// From the differences of neighbours; those while the axis speeds up are few.
void AirWatch::add_noise(Noise& noise, bool feeds, double current_A) {
    if (feeds && noise.last_A) {
        noise.squared_steps += (current_A - *noise.last_A) * (current_A - *noise.last_A);
        ++noise.steps;
    }
    noise.last_A = feeds ? std::optional(current_A) : std::nullopt;
}

std::optional<double> AirWatch::current_noise_A(std::size_t axis) const {
    const Noise& noise = noise_.at(axis);
    return noise.steps > 0 ? std::optional(std::sqrt(noise.squared_steps / static_cast<double>(noise.steps) / 2.0))
                           : std::nullopt;
}

void AirWatch::end() {
    for (const std::size_t axis : axes_) {
        finders_.at(axis).close();
    }
}

void AirWatch::show_fit(std::size_t axis) {
    const std::vector<SteadyFeed>& feeds = finders_.at(axis).found();
    const SteadyFeed& newest = feeds.back();
    std::string line = fmt::format("  {} {:+.0f} mm/min: {:+.3f} A", axis_letter(axis),
                                   newest.feed_m_per_min * mm_min_per_m_min, newest.current_A);
    estimation::FeedCurrentFit fit;
    for (const SteadyFeed& feed : feeds) {
        fit.add(feed.feed_m_per_min, feed.current_A);
    }
    const auto solution = fit.solve();
    if (solution.determined(estimation::common_K_x3) &&
        std::isfinite(solution.standard_error(estimation::common_K_x3))) {
        line += fmt::format(
            "; friction so far: K_x3 {:.3f} ± {:.3f} A, K_x2 {:.3f} ± {:.3f} and {:.3f} ± {:.3f}",
            solution.parameters(estimation::common_K_x3), solution.standard_error(estimation::common_K_x3),
            solution.parameters(estimation::positive_K_x2), solution.standard_error(estimation::positive_K_x2),
            solution.parameters(estimation::negative_K_x2), solution.standard_error(estimation::negative_K_x2));
    }
    tell(line);
}

/// Signed feeds of the program that did not come.
std::vector<double> AirWatch::missing(std::size_t axis) const {
    const std::vector<SteadyFeed>& feeds = finders_.at(axis).found();
    std::vector<double> result;
    for (const double size : feeds_m_per_min_) {
        for (const double feed : {size, -size}) {
            const bool is_there = std::any_of(feeds.begin(), feeds.end(), [&](const SteadyFeed& found) {
                return std::abs(found.feed_m_per_min - feed) < feed_tolerance * size;
            });
            if (!is_there) {
                result.push_back(feed);
            }
        }
    }
    return result;
}

std::string AirWatch::lacks() const {
    std::string words;
    for (const std::size_t axis : axes_) {
        const std::vector<double> feeds = missing(axis);
        if (feeds.empty()) {
            continue;
        }
        words += fmt::format("{}{}:", words.empty() ? "" : "; ", axis_letter(axis));
        for (const double feed : feeds) {
            words += fmt::format(" {:+.0f}", feed * mm_min_per_m_min);
        }
        const auto& found = finders_.at(axis).found();
        if (feeds.size() == 2 * feeds_m_per_min_.size() && !found.empty()) {
            words += fmt::format(" (it moved at {:+.0f})", found.back().feed_m_per_min * mm_min_per_m_min);
        }
        words += " mm/min";
    }
    return words;
}

}  // namespace millforce::host
