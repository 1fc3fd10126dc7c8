// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

/// How today's products set a feed by the spindle's load, each by its published rule. A load is the spindle's current
/// above that of idling, as a share of the rated current. A rule's answer is a factor on F, within the window of
/// 50 to 130 % that all are given. Where a product leaves a setting to its user, it is a parameter with a range, and
/// the benchmark chooses its value on the training parts.

namespace millforce::sim {

struct LoadWindow {
    double lowest = 0.5;
    double highest = 1.3;
};

/// What a rule sees with each sample.
struct LoadView {
    double load = 0.0;       ///< share of the rated current, smoothed
    double reference = 0.0;  ///< the same, as taught
    double dt_s = 0.001;
    double travel_mm = 0.0;  ///< of the tool, in dt_s
};

class LoadRule {
  public:
    virtual ~LoadRule() = default;
    /// The factor on F until the next sample.
    virtual double step(const LoadView& view) = 0;
    /// The rule has stopped the feed, for good.
    [[nodiscard]] virtual bool has_stopped() const { return false; }
};

/// No rule: F.
class ConstantRule : public LoadRule {
  public:
    double step(const LoadView&) override { return 1.0; }
};

/// HEIDENHAIN AFC (TNC 640 and iTNC 530 user's manuals, "Adaptive feed control"; columns FMIN, FMAX, FIDL, FENT, OVLD
/// of AFC.TAB): the override follows the ratio of the taught power to the present one between FMIN = 50 % and
/// FMAX = 130 %. Contact is a load of 2 % over idling; from it on FENT = 100 % holds for the cutter's radius of travel
/// or 600 ms, whichever ends first. In air: FIDL. Where the load stays so high that the rule would want less than 30 %,
/// it stops the feed (OVLD = S). The manuals name no gain: SENS is free, here the rate of an integrator.
class AfcRule : public LoadRule {
  public:
    struct Settings {
        double reference_share = 1.0;  ///< of what was taught
        double gain_per_s = 1.0;       ///< change of the override per second and unit of relative error
        double idle_share = 1.0;       ///< FIDL
        double cutter_radius_mm = 5.0;
    };
    explicit AfcRule(const Settings& settings) : settings_(settings) {}
    double step(const LoadView& view) override;
    [[nodiscard]] bool has_stopped() const override { return stopped_; }

  private:
    enum class State : unsigned char { air, entry, control };

    void enter(const LoadView& view);
    void follow(const LoadView& view);

    Settings settings_;
    State state_ = State::air;
    double entry_s_ = 0.0;
    double entry_mm_ = 0.0;
    double wanted_ = 1.0;
    bool stopped_ = false;
};

/// Haas Autofeed (Haas UK, "Protect your tools"; parameters 299 to 301): every 0.1 s; above the tool's load limit the
/// feed falls by 20 % per second, below 95 % of the limit it rises by 10 % per second, up to the feed that was in
/// effect when the cut began.
class HaasRule : public LoadRule {
  public:
    struct Settings {
        double reference_share = 1.0;  ///< the tool's limit, of what was taught
        double start_share = 1.0;      ///< the operator's override at the start
    };
    explicit HaasRule(const Settings& settings) : settings_(settings), share_(settings.start_share) {}
    double step(const LoadView& view) override;

  private:
    Settings settings_;
    double share_;
    double since_change_s_ = 0.0;
};

/// ToolScope TS-AFC, method "Control" (toolscope.ceratizit.com, "TS-AFC"): the override differs from 100 % by as much
/// as the load from its target, with the opposite sign; the target comes from the upper range of what was learned.
class ToolScopeRule : public LoadRule {
  public:
    explicit ToolScopeRule(double reference_share) : reference_share_(reference_share) {}
    double step(const LoadView& view) override;

  private:
    double reference_share_;
};

/// Siemens SINUMERIK synchronised actions, adaptive control with a multiplicative effect (840D Programming Guide
/// Advanced, edition 04.00, 10.4.11): FCTDEF sets a straight line between limits, SYNFCT puts the load through it:
/// override = 100 % at the reference, and `slope` per unit of load.
class SynfctRule : public LoadRule {
  public:
    struct Settings {
        double reference_share = 1.0;
        double slope = -1.0;  ///< of the override, per share of the reference
        LoadWindow window{};
    };
    explicit SynfctRule(const Settings& settings) : settings_(settings) {}
    double step(const LoadView& view) override;

  private:
    Settings settings_;
};

/// A PID controller of the spindle's load on the adaptive feed, as users of LinuxCNC build it from the components
/// pid(9) and motion.adaptive-feed (M52): error = 1 − load / reference, bias 1, limited output, the integral held while
/// it is at a limit.
class PidRule : public LoadRule {
  public:
    struct Settings {
        double reference_share = 1.0;
        double P = 0.5;
        double I_per_s = 1.0;
        double D_s = 0.0;
    };
    explicit PidRule(const Settings& settings) : settings_(settings) {}
    double step(const LoadView& view) override;

  private:
    Settings settings_;
    double integral_ = 0.0;
    double last_error_ = 0.0;
    bool has_error_ = false;
};

/// A setting that is chosen on the training parts.
struct RuleParameter {
    std::string_view name;
    double low;
    double high;
    double start;
};

struct RuleDescription {
    std::string_view name;
    std::string_view title;
    std::span<const RuleParameter> parameters;
};

/// The F of a rule, a share of the largest constant feed that is safe for a K_s 30 % higher.
constexpr RuleParameter share_of_safe_feed{"feed_share", 0.5, 1.3, 0.9};

/// "constant", "afc", "haas", "toolscope", "synfct", "pid". The first parameter of each is feed_share.
[[nodiscard]] std::span<const RuleDescription> rule_descriptions();
[[nodiscard]] const RuleDescription& rule_named(std::string_view name);

/// `values` in the order of its parameters.
[[nodiscard]] std::unique_ptr<LoadRule> make_rule(std::string_view name, std::span<const double> values,
                                                  double cutter_radius_mm);

}  // namespace millforce::sim
