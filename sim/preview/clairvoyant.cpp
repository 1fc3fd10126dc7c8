// SPDX-License-Identifier: Apache-2.0
#include "preview/clairvoyant.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cutting/angle_units.hpp"
#include "cutting/revolution_load.hpp"
#include "loop/simulation.hpp"
#include "preview/preview.hpp"

namespace millforce::sim {

namespace {

constexpr double no_bound = std::numeric_limits<double>::infinity();

/// The feed per tooth at which the highest tooth carries `limit_N`, to 0.5 % of the force and never above it. Forces
/// grow with the feed and are nearly straight: a chord finds it, and halving where the chord does not shorten the way.
double feed_per_tooth_at(const CuttingForce& force, const EngagementMap& cut, double limit_N, double highest_mm) {
    const auto peak_N = [&](double feed_mm) { return revolution_load(force, feed_mm, cut).peak_tooth_N; };
    double high_mm = highest_mm;
    double high_N = peak_N(high_mm);
    if (high_N <= limit_N) {
        return highest_mm;
    }
    double low_mm = 0.01 * highest_mm;
    double low_N = peak_N(low_mm);
    for (int round = 0; round < 12 && low_N < 0.995 * limit_N && low_N < limit_N; ++round) {
        const double by_chord = (0.998 * limit_N - low_N) / (high_N - low_N);
        const double share = round % 3 == 2 ? 0.5 : std::clamp(by_chord, 0.05, 0.95);
        const double middle_mm = low_mm + share * (high_mm - low_mm);
        const double middle_N = peak_N(middle_mm);
        (middle_N <= limit_N ? low_mm : high_mm) = middle_mm;
        (middle_N <= limit_N ? low_N : high_N) = middle_N;
    }
    return low_mm;
}

/// The plan's feed at each place that a preview passes, before braking.
class TrueFeed {
  public:
    TrueFeed(const Scenario& scenario, double share)
        : plant_(deviated(scenario, scenario.deviation, scenario.seed)),
          force_(plant_.cutter, plant_.coefficients, plant_.cutting_options),
          limit_N_(share * static_cast<double>(scenario.parameters.tool.tooth_force_limit_N)),
          override_max_(static_cast<double>(scenario.parameters.machine.cnc.override_max)) {}

    double at(const host::MapPlace& place, const EngagementMap& engagement) {
        if (place.rapid) {
            return no_bound;
        }
        const double highest_mm_s = override_max_ * place.programmed_feed_mm_s;
        const double teeth_per_s = place.spindle_speed_rad_s / turn * static_cast<double>(plant_.cutter.teeth);
        if (place.cut.empty() || !(teeth_per_s > 0.0)) {
            return highest_mm_s;
        }
        if (!last_ || !host::is_same_cut(*last_, place)) {
            last_ = place;
            last_feed_mm_s_ = teeth_per_s * feed_per_tooth_at(force_, engagement, limit_N_, highest_mm_s / teeth_per_s);
        }
        return last_feed_mm_s_;
    }

  private:
    Scenario plant_;
    CuttingForce force_;
    double limit_N_;
    double override_max_;
    std::optional<host::MapPlace> last_;  // whose forces were worked out
    double last_feed_mm_s_ = 0.0;
};

}  // namespace

ClairvoyantFeed::ClairvoyantFeed(const Scenario& scenario, double share)
    : position_(preview(scenario, 0.1,
                        [this, feed = TrueFeed(scenario, share)](const host::MapPlace& place,
                                                                 const EngagementMap& engagement) mutable {
                            plan_.push_back({place.path_mm, feed.at(place, engagement)});
                        })) {
    lower_to_neighbours();
    brake_in_time(static_cast<double>(scenario.parameters.machine.cnc.acceleration_mm_s2));
}

void ClairvoyantFeed::brake_in_time(double acceleration_mm_s2) {
    for (std::size_t i = plan_.size(); i-- > 1;) {
        const double next_mm_s = plan_[i].feed_mm_s;
        const double way_mm = plan_[i].path_mm - plan_[i - 1].path_mm;
        const double fastest_mm_s = std::sqrt(next_mm_s * next_mm_s + 2.0 * acceleration_mm_s2 * way_mm);
        plan_[i - 1].feed_mm_s = std::min(plan_[i - 1].feed_mm_s, fastest_mm_s);
    }
}

/// The axes follow their commands with a lag: a feed is there a little early and stays a little longer.
void ClairvoyantFeed::lower_to_neighbours() {
    constexpr double early_mm = 1.0;
    constexpr double longer_mm = 0.5;
    const std::vector<Place> sharp = plan_;
    std::size_t first = 0;
    std::size_t end = 0;
    for (Place& place : plan_) {
        while (first < sharp.size() && sharp[first].path_mm < place.path_mm - longer_mm) {
            ++first;
        }
        while (end < sharp.size() && sharp[end].path_mm <= place.path_mm + early_mm) {
            ++end;
        }
        for (std::size_t k = first; k < end; ++k) {
            place.feed_mm_s = std::min(place.feed_mm_s, sharp[k].feed_mm_s);
        }
    }
}

double ClairvoyantFeed::feed_at(double path_mm) const {
    const auto after = std::ranges::upper_bound(plan_, path_mm, {}, &Place::path_mm);
    return after == plan_.begin() || after == plan_.end() ? no_bound : (after - 1)->feed_mm_s;
}

hal::FeedOverride ClairvoyantFeed::step(const hal::DriveSample&, const hal::ProgramStatus& program) {
    constexpr double sample_s = 0.001;  // in which the tool goes on
    constexpr double largest_ratio = 10.0;
    hal::FeedOverride output;
    output.hold = false;
    output.ratio = 1.0F;
    const auto path_mm = position_.find(program.line, static_cast<double>(program.distance_to_go_mm));
    if (program.rapid || !path_mm || !(program.programmed_feed_mm_s > 0.0F)) {
        return output;
    }
    const double here_mm_s = feed_at(*path_mm);
    const double next_mm_s = std::isfinite(here_mm_s) ? feed_at(*path_mm + here_mm_s * sample_s) : here_mm_s;
    const double ratio = std::min(here_mm_s, next_mm_s) / static_cast<double>(program.programmed_feed_mm_s);
    output.ratio = static_cast<float>(std::min(ratio, largest_ratio));
    return output;
}

RunResult clairvoyant_run(const Scenario& scenario) {
    Scenario prompt = scenario;
    prompt.parameters.machine.cnc.override_latency_s = 0.0F;
    ClairvoyantFeed plan(prompt);
    return simulate(prompt, plan, "plan").result;
}

}  // namespace millforce::sim
