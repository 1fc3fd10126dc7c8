// SPDX-License-Identifier: Apache-2.0
#include "part_map/part_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimation/cutting/peak_factors.hpp"
#include "estimation/number/circle.hpp"

namespace millforce::host {

namespace {

using Angles = estimation::EngagementAngles<float>;

/// The forces of a cut at any feed.
class CutAt {
  public:
    CutAt(const firmware::ToolParameters<float>& tool, const std::vector<EngagedArc>& cut)
        : tool_(tool),
          radians_per_mm_(std::tan(tool.helix_deg * std::numbers::pi_v<float> / 180.0F) / (0.5F * tool.diameter_mm)) {
        for (const EngagedArc& arc : cut) {
            arcs_.push_back({{static_cast<float>(arc.entry_rad), static_cast<float>(arc.exit_rad)},
                             static_cast<float>(arc.axial_depth_mm)});
        }
    }

    /// Of the tooth with the largest radius: it takes the runout on top of its chip, at most the chips of all teeth.
    [[nodiscard]] float highest_tooth_N(float feed_per_tooth_mm) const {
        const float runout_mm = 0.001F * tool_.runout_um;
        return mean_tooth_N(
            std::min(feed_per_tooth_mm + runout_mm, static_cast<float>(tool_.teeth) * feed_per_tooth_mm));
    }

    /// Largest in-plane force of a mean tooth on its way through all arcs.
    [[nodiscard]] float mean_tooth_N(float feed_per_tooth_mm) const {
        constexpr int steps = 72;
        float last_rad = 0.0F;
        for (const Arc& arc : arcs_) {
            last_rad = std::max(last_rad, arc.angles.exit_rad + sweep_rad(arc));
        }
        const float first_rad = arcs_.front().angles.entry_rad;
        std::vector<estimation::ToothInCut<float>> in_arcs;
        for (const Arc& arc : arcs_) {
            in_arcs.emplace_back(tool_.law, feed_per_tooth_mm, arc.depth_mm, sweep_rad(arc), arc.angles);
        }
        float largest_N = 0.0F;
        for (int k = 0; k <= steps; ++k) {
            const float tip_rad =
                first_rad + (last_rad - first_rad) * static_cast<float>(k) / static_cast<float>(steps);
            float feed_N = 0.0F;
            float normal_N = 0.0F;
            for (const estimation::ToothInCut<float>& tooth : in_arcs) {
                const auto force = tooth.force_at(tip_rad);
                feed_N += force.feed_N;
                normal_N += force.normal_N;
            }
            largest_N = std::max(largest_N, std::hypot(feed_N, normal_N));
        }
        return largest_N;
    }

    /// Mean forces of all teeth and arcs.
    [[nodiscard]] estimation::AverageForces<float> mean(float feed_per_tooth_mm) const {
        estimation::AverageForces<float> sum{};
        for (const Arc& arc : arcs_) {
            const auto of_arc = estimation::average_forces(
                tool_.law, estimation::CutConditions<float>{feed_per_tooth_mm, arc.depth_mm, arc.angles,
                                                            static_cast<float>(tool_.teeth)});
            sum.tangential_N += of_arc.tangential_N;
            sum.feed_N += of_arc.feed_N;
            sum.normal_N += of_arc.normal_N;
        }
        return sum;
    }

    /// The feed per tooth at which the highest tooth carries `force_N`; at most `highest_mm`.
    [[nodiscard]] float feed_per_tooth_at(float force_N, float highest_mm) const {
        if (highest_tooth_N(highest_mm) <= force_N) {
            return highest_mm;
        }
        constexpr int halvings = 12;
        float low_mm = 0.0F;
        float high_mm = highest_mm;
        for (int i = 0; i < halvings; ++i) {
            const float middle_mm = 0.5F * (low_mm + high_mm);
            (highest_tooth_N(middle_mm) <= force_N ? low_mm : high_mm) = middle_mm;
        }
        return 0.5F * (low_mm + high_mm);
    }

  private:
    struct Arc {
        Angles angles;
        float depth_mm;
    };

    [[nodiscard]] float sweep_rad(const Arc& arc) const { return arc.depth_mm * radians_per_mm_; }

    const firmware::ToolParameters<float>& tool_;
    float radians_per_mm_;
    std::vector<Arc> arcs_;
};

/// The cut with an arc that is wider by `wider_rad`, of the depth that gives the same F_at.
CutAt with_other_arc(const MapPlace& place, double wider_rad, const firmware::ToolParameters<float>& tool,
                     float feed_per_tooth_mm) {
    constexpr double least_rad = 0.05;
    EngagedArc arc = place.cut.front();
    const double width_rad = std::clamp(arc.exit_rad - arc.entry_rad + wider_rad, least_rad, std::numbers::pi);
    const bool ends_behind = arc.entry_rad > 0.0;  // down milling
    arc.entry_rad = ends_behind ? std::max(arc.exit_rad - width_rad, 0.0) : arc.entry_rad;
    arc.exit_rad = std::min(arc.entry_rad + width_rad, std::numbers::pi);
    const auto mean_N = [&](const EngagedArc& of) { return CutAt(tool, {of}).mean(feed_per_tooth_mm).tangential_N; };
    arc.axial_depth_mm *= static_cast<double>(mean_N(place.cut.front()) / mean_N(arc));
    if (tool.flute_length_mm > 0.0F) {
        arc.axial_depth_mm = std::min(arc.axial_depth_mm, static_cast<double>(tool.flute_length_mm));
    }
    return {tool, {arc}};
}

bool is_same_arc(const EngagedArc& a, const EngagedArc& b) {
    constexpr double alike_rad = 0.005;
    constexpr double alike_mm = 0.01;
    return std::abs(a.entry_rad - b.entry_rad) < alike_rad && std::abs(a.exit_rad - b.exit_rad) < alike_rad &&
           std::abs(a.axial_depth_mm - b.axial_depth_mm) < alike_mm;
}

control::Stretch<float> stretch_at(const MapPlace& place, const firmware::Parameters<float>& parameters) {
    const firmware::ToolParameters<float>& tool = parameters.tool;
    const auto programmed_mm_s = static_cast<float>(place.programmed_feed_mm_s);
    const float teeth_per_s = static_cast<float>(place.spindle_speed_rad_s) * estimation::turns_per_rad<float> *
                              static_cast<float>(tool.teeth);
    control::Stretch<float> stretch;
    stretch.begin_mm = static_cast<float>(place.path_mm);
    stretch.feed_mm_s = place.rapid ? programmed_mm_s : programmed_mm_s * parameters.machine.cnc.override_max;
    stretch.is_known = place.known != Known::nothing;
    if (!stretch.is_known) {
        stretch.feed_mm_s = std::max(stretch.feed_mm_s, 1.0F);  // of no use, but it has to be one
        return stretch;
    }
    if (place.cut.empty() || !(teeth_per_s > 0.0F)) {
        return stretch;
    }
    stretch.least_share = place.known == Known::at_most ? static_cast<float>(place.least_share) : 1.0F;
    const auto hardness = static_cast<float>(place.hardness);
    const CutAt cut(tool, place.cut);
    const float target_N = tool.control.setpoint_share * tool.tooth_force_limit_N / hardness;
    // A hardness below 1 allows more than the feed of this stretch, up to the override's end: it is not cut off here.
    const float highest_mm = 2.0F * stretch.feed_mm_s / teeth_per_s;
    float feed_per_tooth_mm = cut.feed_per_tooth_at(target_N, highest_mm);
    float tooth_N = cut.mean_tooth_N(feed_per_tooth_mm);
    if (place.arc_sd_rad > 0.0 && place.cut.size() == 1) {
        // The mean forces may be those of a wider or a narrower cut, whose teeth carry more.
        const double doubt_rad = static_cast<double>(tool.control.caution_sd) * place.arc_sd_rad;
        const CutAt wider = with_other_arc(place, doubt_rad, tool, feed_per_tooth_mm);
        const CutAt narrower = with_other_arc(place, -doubt_rad, tool, feed_per_tooth_mm);
        feed_per_tooth_mm = std::min({feed_per_tooth_mm, wider.feed_per_tooth_at(target_N, highest_mm),
                                      narrower.feed_per_tooth_at(target_N, highest_mm)});
        tooth_N = std::max({cut.mean_tooth_N(feed_per_tooth_mm), wider.mean_tooth_N(feed_per_tooth_mm),
                            narrower.mean_tooth_N(feed_per_tooth_mm)});
    }
    // Secants where the feed and the hardness are mostly found: half the feed, and a batch that is 30 % harder.
    constexpr float harder = 1.3F;
    const float harder_feed_mm =
        cut.feed_per_tooth_at(cut.highest_tooth_N(feed_per_tooth_mm) / harder, feed_per_tooth_mm);
    stretch.feed_mm_s = feed_per_tooth_mm * teeth_per_s;
    const auto mean = cut.mean(feed_per_tooth_mm);
    stretch.tangential_N = hardness * mean.tangential_N;
    stretch.tooth_per_tangential = tooth_N / mean.tangential_N;
    stretch.feed_per_tangential = mean.feed_N / mean.tangential_N;
    stretch.falling_share = 2.0F * (1.0F - cut.mean(0.5F * feed_per_tooth_mm).tangential_N / mean.tangential_N);
    stretch.feed_per_softness = (1.0F - harder_feed_mm / feed_per_tooth_mm) / (1.0F - 1.0F / harder);
    return stretch;
}

bool may_join(const control::Stretch<float>& a, const control::Stretch<float>& b) {
    constexpr float alike = 0.03F;
    const auto are_alike = [](float x, float y) { return std::abs(x - y) <= alike * std::max(x, y); };
    return a.is_known == b.is_known && a.least_share == b.least_share &&
           (a.tangential_N > 0.0F) == (b.tangential_N > 0.0F) && are_alike(a.feed_mm_s, b.feed_mm_s) &&
           are_alike(a.tangential_N, b.tangential_N) && are_alike(a.tooth_per_tangential, b.tooth_per_tangential) &&
           std::abs(a.feed_per_tangential - b.feed_per_tangential) <= alike;
}

}  // namespace

bool is_same_cut(const MapPlace& a, const MapPlace& b) {
    return a.rapid == b.rapid && a.programmed_feed_mm_s == b.programmed_feed_mm_s &&
           a.spindle_speed_rad_s == b.spindle_speed_rad_s && a.known == b.known && a.least_share == b.least_share &&
           a.hardness == b.hardness && std::ranges::equal(a.cut, b.cut, is_same_arc);
}

double immersion_of(const MapPlace& place) {
    double immersion = 0.0;
    for (const EngagedArc& arc : place.cut) {
        immersion += std::cos(arc.entry_rad) - std::cos(arc.exit_rad);
    }
    return immersion;
}

double tooth_force_N(const MapPlace& place, const firmware::ToolParameters<float>& tool) {
    const double teeth_per_s =
        place.spindle_speed_rad_s * estimation::turns_per_rad<double> * static_cast<double>(tool.teeth);
    if (place.cut.empty() || place.known == Known::nothing || !(teeth_per_s > 0.0)) {
        return 0.0;
    }
    const auto feed_per_tooth_mm = static_cast<float>(place.programmed_feed_mm_s / teeth_per_s);
    return place.hardness * static_cast<double>(CutAt(tool, place.cut).highest_tooth_N(feed_per_tooth_mm));
}

std::vector<control::Stretch<float>> stretches_of(const PartMap& map, const firmware::Parameters<float>& parameters) {
    std::vector<control::Stretch<float>> stretches;
    const MapPlace* last = nullptr;
    control::Stretch<float> here;
    for (const MapPlace& place : map) {
        if (last == nullptr || !is_same_cut(*last, place)) {
            last = &place;
            here = stretch_at(place, parameters);
        }
        here.begin_mm = static_cast<float>(place.path_mm);
        if (stretches.empty() || !may_join(stretches.back(), here)) {
            if (stretches.empty() || here.begin_mm > stretches.back().begin_mm) {
                stretches.push_back(here);
            }
        } else {
            stretches.back().feed_mm_s = std::min(stretches.back().feed_mm_s, here.feed_mm_s);
        }
    }
    if (!map.empty() && map.back().path_mm > static_cast<double>(stretches.back().begin_mm)) {
        here.begin_mm = static_cast<float>(map.back().path_mm);
        stretches.push_back(here);
    }
    return stretches;
}

}  // namespace millforce::host
