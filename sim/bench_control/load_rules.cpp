// SPDX-License-Identifier: Apache-2.0
#include "bench_control/load_rules.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace millforce::sim {

namespace {

constexpr LoadWindow given_window{};

double in_window(double share) {
    return std::clamp(share, given_window.lowest, given_window.highest);
}

/// Load over its reference; an empty reference is never reached.
double relative_load(const LoadView& view, double share) {
    const double reference = share * view.reference;
    return reference > 0.0 ? view.load / reference : 0.0;
}

}  // namespace

double AfcRule::step(const LoadView& view) {
    constexpr double contact_load = 0.02;
    if (view.load < contact_load) {
        state_ = State::air;
        wanted_ = 1.0;
        return settings_.idle_share;
    }
    switch (state_) {
        case State::air:
            state_ = State::entry;
            entry_s_ = 0.0;
            entry_mm_ = 0.0;
            break;
        case State::entry:
            enter(view);
            break;
        case State::control:
            follow(view);
            break;
    }
    return in_window(wanted_);
}

void AfcRule::enter(const LoadView& view) {
    constexpr double longest_s = 0.6;
    entry_s_ += view.dt_s;
    entry_mm_ += view.travel_mm;
    if (entry_s_ >= longest_s || entry_mm_ >= settings_.cutter_radius_mm) {
        state_ = State::control;
    }
}

void AfcRule::follow(const LoadView& view) {
    constexpr double stop_share = 0.3;
    const double error = 1.0 - relative_load(view, settings_.reference_share);
    wanted_ = std::min(wanted_ + settings_.gain_per_s * error * view.dt_s, given_window.highest);
    stopped_ = stopped_ || wanted_ < stop_share;
}

double HaasRule::step(const LoadView& view) {
    constexpr double period_s = 0.1;
    constexpr double down_per_s = 0.20;
    constexpr double up_per_s = 0.10;
    constexpr double recovered = 0.95;
    since_change_s_ += view.dt_s;
    if (since_change_s_ < period_s - 0.5 * view.dt_s) {
        return share_;
    }
    since_change_s_ = 0.0;
    const double load = relative_load(view, settings_.reference_share);
    if (load > 1.0) {
        share_ = std::max(share_ - down_per_s * period_s, given_window.lowest);
    } else if (load < recovered) {
        share_ = std::min(share_ + up_per_s * period_s, settings_.start_share);
    }
    return share_;
}

double ToolScopeRule::step(const LoadView& view) {
    return in_window(2.0 - relative_load(view, reference_share_));
}

double SynfctRule::step(const LoadView& view) {
    const double override = 1.0 + settings_.slope * (relative_load(view, settings_.reference_share) - 1.0);
    return std::clamp(override, settings_.window.lowest, settings_.window.highest);
}

double PidRule::step(const LoadView& view) {
    const double error = 1.0 - relative_load(view, settings_.reference_share);
    const double change_per_s = has_error_ ? (error - last_error_) / view.dt_s : 0.0;
    last_error_ = error;
    has_error_ = true;
    const double now = 1.0 + settings_.P * error + integral_ + settings_.D_s * change_per_s;
    const bool is_limited = (now > given_window.highest && error > 0.0) || (now < given_window.lowest && error < 0.0);
    integral_ += is_limited ? 0.0 : settings_.I_per_s * error * view.dt_s;
    return in_window(now);
}

namespace {

constexpr RuleParameter reference_share{"reference_share", 0.4, 1.6, 1.2};

constexpr std::array constant_parameters{share_of_safe_feed};
constexpr std::array afc_parameters{share_of_safe_feed, reference_share, RuleParameter{"gain_per_s", 0.1, 6.0, 2.0},
                                    RuleParameter{"idle_share", 1.0, 1.3, 1.1}};
constexpr std::array haas_parameters{share_of_safe_feed, reference_share, RuleParameter{"start_share", 0.8, 1.3, 1.1}};
constexpr std::array toolscope_parameters{share_of_safe_feed, reference_share};
constexpr std::array synfct_parameters{share_of_safe_feed, reference_share, RuleParameter{"slope", -3.0, -0.1, -1.0}};
constexpr std::array pid_parameters{share_of_safe_feed, reference_share, RuleParameter{"P", 0.0, 2.0, 0.3},
                                    RuleParameter{"I_per_s", 0.0, 6.0, 1.5}, RuleParameter{"D_s", 0.0, 0.05, 0.002}};

constexpr std::array all_rules{
    RuleDescription{"constant", "Constant feed", constant_parameters},
    RuleDescription{"afc", "AFC (HEIDENHAIN)", afc_parameters},
    RuleDescription{"haas", "Autofeed (Haas)", haas_parameters},
    RuleDescription{"toolscope", "TS-AFC (ToolScope)", toolscope_parameters},
    RuleDescription{"synfct", "SYNFCT (Siemens)", synfct_parameters},
    RuleDescription{"pid", "PID on the load", pid_parameters},
};

}  // namespace

std::span<const RuleDescription> rule_descriptions() {
    return all_rules;
}

const RuleDescription& rule_named(std::string_view name) {
    const auto* const rule = std::ranges::find(all_rules, name, &RuleDescription::name);
    if (rule == all_rules.end()) {
        throw std::logic_error("no rule '" + std::string(name) + "'");
    }
    return *rule;
}

std::unique_ptr<LoadRule> make_rule(std::string_view name, std::span<const double> values, double cutter_radius_mm) {
    if (values.size() != rule_named(name).parameters.size()) {
        throw std::logic_error("rule '" + std::string(name) + "': another number of settings");
    }
    if (name == "afc") {
        return std::make_unique<AfcRule>(AfcRule::Settings{values[1], values[2], values[3], cutter_radius_mm});
    }
    if (name == "haas") {
        return std::make_unique<HaasRule>(HaasRule::Settings{values[1], values[2]});
    }
    if (name == "toolscope") {
        return std::make_unique<ToolScopeRule>(values[1]);
    }
    if (name == "synfct") {
        return std::make_unique<SynfctRule>(SynfctRule::Settings{values[1], values[2], {}});
    }
    if (name == "pid") {
        return std::make_unique<PidRule>(PidRule::Settings{values[1], values[2], values[3], values[4]});
    }
    return std::make_unique<ConstantRule>();
}

}  // namespace millforce::sim
