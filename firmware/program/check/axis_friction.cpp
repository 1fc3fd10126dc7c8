// SPDX-License-Identifier: Apache-2.0
#include "check/axis_friction.hpp"

#include "check/drive_keys.hpp"
#include "estimation/drives/feed_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace millforce::host {

namespace {

using AxisParameters = estimation::FeedDriveParameters<float>;
using AxisAverage = estimation::FeedDrive<float>::Average;

AxisParameters without_friction(AxisParameters axis) {
    axis.positive = axis.negative = {};
    axis.K_x3_A = 0.0F;
    return axis;
}

/// κ in one direction of travel.
class FrictionMean {
  public:
    void add(double scale, double friction_A, double samples) {
        ++windows_;
        scale_ += scale;
        friction_A_ += friction_A;
        samples_ += samples;
    }
    [[nodiscard]] bool is_there() const { return windows_ > 0; }
    [[nodiscard]] double scale() const { return scale_ / windows_; }
    [[nodiscard]] double friction_A() const { return friction_A_ / windows_; }
    [[nodiscard]] double samples() const { return samples_; }

  private:
    double samples_ = 0.0;
    double windows_ = 0.0;
    double scale_ = 0.0;
    double friction_A_ = 0.0;
};

struct FrictionSeen {
    double scale = 0.0;        ///< κ
    double measured_sd = 0.0;  ///< of κ: ripple and noise
};

/// What a current says of the friction, while an axis with these parameters moves at a velocity.
class FrictionOfAxis {
  public:
    explicit FrictionOfAxis(const AxisParameters& axis) : axis_(axis), with_(axis), without_(without_friction(axis)) {}

    void add(double current_A, const MotionWindow& window, std::size_t moving_axis) {
        AxisAverage average;
        average.current_A = static_cast<float>(current_A);
        average.velocity_mm_s = static_cast<float>(window.axes.at(moving_axis).velocity_mm_s);
        average.duration_s = static_cast<float>(window.duration_s);
        average.samples = static_cast<float>(window.samples);
        average.present = true;
        if (!with_.is_moving(average)) {
            return;
        }
        const double beyond_friction_N = static_cast<double>(with_.force_N(average).value);
        const double with_friction_N = static_cast<double>(without_.force_N(average).value);
        const double friction_N = with_friction_N - beyond_friction_N;
        const double friction_A = std::abs(friction_N) / static_cast<double>(axis_.K_x4_N_per_A);
        if (friction_A > static_cast<double>(axis_.current_sd_A) / std::sqrt(static_cast<double>(window.samples))) {
            means_.at(average.velocity_mm_s > 0.0F ? 1 : 0)
                .add(with_friction_N / friction_N, friction_A, static_cast<double>(window.samples));
        }
    }

    [[nodiscard]] bool has_both_directions() const { return means_[0].is_there() && means_[1].is_there(); }

    /// The mean of both directions: a constant current, as of an axis at rest, has no say in it.
    [[nodiscard]] std::optional<FrictionSeen> seen() const {
        double scale = 0.0;
        double friction_A = 0.0;
        double samples = 0.0;
        double directions = 0.0;
        for (const FrictionMean& mean : means_) {
            if (mean.is_there()) {
                scale += mean.scale();
                friction_A += mean.friction_A();
                samples += mean.samples();
                directions += 1.0;
            }
        }
        if (directions == 0.0) {
            return std::nullopt;
        }
        const double noise_A = static_cast<double>(axis_.current_sd_A) / std::sqrt(samples);
        const double doubt_A = std::hypot(static_cast<double>(axis_.friction_ripple_A), noise_A);
        return FrictionSeen{scale / directions, doubt_A * directions / friction_A};
    }

    /// Whether κ lies within four standard deviations of `expected`.
    [[nodiscard]] bool explains(const FrictionSeen& seen, double expected) const {
        const double stated_sd = static_cast<double>(axis_.friction_relative_sd);
        return estimation::may_be_learnt_in_air(seen.scale - expected,
                                                stated_sd * stated_sd + seen.measured_sd * seen.measured_sd);
    }

  private:
    AxisParameters axis_;
    estimation::FeedDrive<float> with_;
    estimation::FeedDrive<float> without_;
    std::array<FrictionMean, 2> means_;  // − direction, + direction
};

/// `current_axis`'s current, while `moving_axis` moves in air. Where they differ, the former rests.
std::optional<FrictionOfAxis> friction_seen(std::span<const MotionWindow> windows, std::size_t current_axis,
                                            std::size_t moving_axis, const AxisParameters& moving) {
    FrictionOfAxis friction(moving);
    for (const MotionWindow& window : windows) {
        const AxisWindow& own = window.axes.at(current_axis);
        const bool is_asked = own.is_present && window.axes.at(moving_axis).is_steady() &&
                              (current_axis == moving_axis || own.is_at_rest());
        if (window.place == ToolPlace::in_air && is_asked) {
            friction.add(own.current_A, window, moving_axis);
        }
    }
    return friction.seen() ? std::optional(friction) : std::nullopt;
}

/// Another axis whose motion the current follows while its own axis rests: to and fro, or in one direction where the
/// other's current follows this axis as well. In one direction alone the current of an axis at rest may look like that.
std::optional<std::size_t> followed_axis(std::span<const MotionWindow> windows,
                                         const firmware::MachineParameters<float>& machine, std::size_t axis) {
    for (std::size_t other = 0; other < machine.axes.size(); ++other) {
        if (other == axis) {
            continue;
        }
        const auto follows = [&](std::size_t current_axis, std::size_t moving_axis) {
            const auto friction = friction_seen(windows, current_axis, moving_axis, machine.axes.at(moving_axis));
            return friction && friction->explains(*friction->seen(), 1.0) ? friction : std::nullopt;
        };
        const auto friction = follows(axis, other);
        if (friction && (friction->has_both_directions() || follows(other, axis))) {
            return other;
        }
    }
    return std::nullopt;
}

std::string_view axis_name(std::size_t axis) {
    return drive_names.at(axis + 1);
}

std::string key_of_axis(std::size_t axis, std::string_view key) {
    return fmt::format("{}.{}", axis_name(axis), key);
}

/// A friction that its stated deviation does not explain.
Finding wrong_friction(std::span<const MotionWindow> windows, const firmware::MachineParameters<float>& machine,
                       std::size_t axis, const FrictionOfAxis& friction) {
    const std::string_view name = axis_name(axis);
    const FrictionSeen seen = *friction.seen();
    if (const auto other = followed_axis(windows, machine, axis)) {
        return {Severity::error,
                fmt::format("{}: the current follows the motion of {}: are the axes swapped?", name, axis_name(*other)),
                key_of_current(machine, axis + 1, "node_id")};
    }
    if (friction.explains(seen, -1.0)) {
        return {Severity::error,
                fmt::format("{}: the current is reversed: in air it drives against the friction ({:.2f} times that of "
                            "the file)",
                            name, seen.scale),
                key_of_current(machine, axis + 1, "current_reversed")};
    }
    constexpr double dead = 0.2;
    if (std::abs(seen.scale) < dead) {
        return {Severity::error,
                fmt::format("{}: the current does not follow the motion: is it connected, and to this axis?", name),
                fmt::format("{}_current_A", name)};
    }
    const std::string what = fmt::format("{}: the friction in air is {:.3g} times that of the file", name, seen.scale);
    if (const int direction = peak_for_rms(seen.scale); direction != 0) {
        return {Severity::warning, what + ": " + words_for_peak_and_rms(direction),
                key_of_current(machine, axis + 1, "current_basis")};
    }
    return {Severity::warning,
            what + ", beyond its stated deviation: of another machine, or the current in another unit",
            key_of_axis(axis, "friction_relative_sd")};
}

/// κ of the axes whose friction is as stated, to be compared among each other.
class SharedFactor {
  public:
    void add(std::size_t axis, double scale) { scales_.emplace_back(axis, scale); }

    [[nodiscard]] Findings findings(const firmware::MachineParameters<float>& machine) const {
        Findings findings;
        for (const auto& [axis, scale] : scales_) {
            const int direction = peak_for_rms(scale);
            const auto alike = std::count_if(scales_.begin(), scales_.end(), [&](const auto& other) {
                return peak_for_rms(other.second) == direction;
            });
            if (direction != 0) {
                findings.push_back({alike > 1 ? Severity::warning : Severity::note,
                                    fmt::format("{}: the friction in air is {:.3g} times that of the file: {}",
                                                axis_name(axis), scale, words_for_peak_and_rms(direction)),
                                    key_of_current(machine, axis + 1, "current_basis")});
            }
        }
        return findings;
    }

  private:
    std::vector<std::pair<std::size_t, double>> scales_;
};

double largest_magnitude_A(std::span<const MotionWindow> windows, std::size_t axis) {
    double largest_A = 0.0;
    for (const MotionWindow& window : windows) {
        const AxisWindow& own = window.axes.at(axis);
        largest_A = own.is_present ? std::max(largest_A, std::abs(own.current_A)) : largest_A;
    }
    return largest_A;
}

bool moves_at_all(std::span<const MotionWindow> windows, std::size_t axis) {
    return std::any_of(windows.begin(), windows.end(),
                       [axis](const MotionWindow& window) { return window.axes.at(axis).is_steady(); });
}

/// What the current says without its friction; nothing where it is to be judged by that.
std::optional<Finding> check_magnitude(std::span<const MotionWindow> windows,
                                       const firmware::MachineParameters<float>& machine, std::size_t axis,
                                       bool current_stands) {
    const std::string column = fmt::format("{}_current_A", axis_name(axis));
    if (!moves_at_all(windows, axis)) {
        return Finding{Severity::note,
                       fmt::format("{}: it never moves at a steady feed: its current is not judged", axis_name(axis)),
                       column};
    }
    if (current_stands) {
        return Finding{
            Severity::error,
            fmt::format("{}: the current never changes although the axis moves: is it connected?", axis_name(axis)),
            column};
    }
    const double largest_A = largest_magnitude_A(windows, axis);
    const double allowed_A = largest_current_A(machine, axis + 1);
    if (largest_A > allowed_A) {
        return Finding{Severity::error,
                       fmt::format("{}: a current of {:.4g} A, expected at most {:.4g} A; is it in mA, or per mille of "
                                   "the rated current?",
                                   axis_name(axis), largest_A, allowed_A),
                       column};
    }
    return std::nullopt;
}

/// A constant current passes for friction then.
Findings one_direction_only(std::size_t axis, const FrictionOfAxis& friction) {
    if (friction.has_both_directions()) {
        return {};
    }
    return {{Severity::note,
             fmt::format("{}: in air it moves in one direction only: friction and a constant current look alike",
                         axis_name(axis)),
             key_of_axis(axis, "K_x3_A")}};
}

}  // namespace

Findings check_axis_currents(std::span<const MotionWindow> windows, const firmware::MachineParameters<float>& machine,
                             const std::array<bool, hal::axis_count>& current_stands) {
    Findings findings;
    SharedFactor shared;
    for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
        const AxisParameters& parameters = machine.axes.at(axis);
        if (!(parameters.K_x4_N_per_A > 0.0F)) {
            continue;
        }
        if (const auto finding = check_magnitude(windows, machine, axis, current_stands.at(axis))) {
            findings.push_back(*finding);
            continue;
        }
        const auto friction = friction_seen(windows, axis, axis, parameters);
        if (!friction) {
            findings.push_back(
                {Severity::note,
                 fmt::format("{}: no steady motion in air, or no friction in the file: they are not compared",
                             axis_name(axis)),
                 key_of_axis(axis, "K_x3_A")});
        } else if (friction->explains(*friction->seen(), 1.0)) {
            shared.add(axis, friction->seen()->scale);
            append(findings, one_direction_only(axis, *friction));
        } else {
            findings.push_back(wrong_friction(windows, machine, axis, *friction));
        }
    }
    append(findings, shared.findings(machine));
    return findings;
}

}  // namespace millforce::host
