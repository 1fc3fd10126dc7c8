// SPDX-License-Identifier: Apache-2.0
#include "check/air.hpp"

#include "check/spindle_idle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace millforce::host {

namespace {

/// A window whose spindle current is that of air.
struct KnownIdle {
    const MotionWindow* window = nullptr;

    [[nodiscard]] bool is_for(const MotionWindow& other) const {
        constexpr double same_speed = 0.03;
        return window != nullptr && std::abs(other.turned_rev / other.duration_s * window->duration_s -
                                             window->turned_rev) < same_speed * window->turned_rev;
    }
    [[nodiscard]] double current_A() const { return std::abs(window->spindle_current_A); }
};

/// By which the mean current of a window may exceed that of air.
class IdleTolerance {
  public:
    explicit IdleTolerance(const firmware::Parameters<float>& parameters)
        : drive_(parameters.machine.spindle),
          current_sd_A_(static_cast<double>(parameters.machine.spindle.current_sd_A)),
          contact_torque_Nm_(static_cast<double>(parameters.tool.control.contact_force_N) *
                             static_cast<double>(parameters.tool.diameter_mm) * 0.5e-3) {}

    [[nodiscard]] double of_A(const MotionWindow& window) const {
        constexpr double deviations = 4.0;
        const auto speed_rad_s = static_cast<float>(window.spindle_rad_s());
        return deviations * current_sd_A_ / std::sqrt(static_cast<double>(window.samples)) +
               contact_torque_Nm_ / static_cast<double>(drive_.torque_constant_Nm_per_A(speed_rad_s));
    }

  private:
    estimation::SpindleDrive<float> drive_;
    double current_sd_A_;
    double contact_torque_Nm_;
};

/// No chip is left to cut where the axes have already rested for a revolution.
bool follows_rest(const MotionWindow& before, const MotionWindow& window) {
    return before.is_at_rest() && before.turned_rev >= 1.0 && window.start_s - before.end_s() < 1e-6;
}

/// Returns whether the spindle turned in any of it.
bool mark_certain_air(std::span<MotionWindow> windows) {
    bool turned = false;
    for (std::size_t k = 0; k < windows.size(); ++k) {
        MotionWindow& window = windows[k];
        const bool spindle_stands = std::abs(window.turned_rev) < 0.01;
        const bool rests = window.is_at_rest() && k > 0 && follows_rest(windows[k - 1], window);
        if (spindle_stands || window.is_rapid || rests) {
            window.place = ToolPlace::in_air;
            turned = turned || (window.turns_steadily() && window.has_spindle_current);
        }
    }
    return turned;
}

bool shows_idle(const MotionWindow& window) {
    return window.place == ToolPlace::in_air && window.has_spindle_current && window.turns_steadily();
}

/// The last certain air before each window, and the next one after it. The idle torque changes slowly, as the spindle
/// warms up: the nearest of both sides are compared with.
std::vector<KnownIdle> idle_before(std::span<const MotionWindow> windows) {
    std::vector<KnownIdle> known(windows.size());
    KnownIdle last;
    for (std::size_t k = 0; k < windows.size(); ++k) {
        known[k] = last;
        last = shows_idle(windows[k]) ? KnownIdle{&windows[k]} : last;
    }
    return known;
}
std::vector<KnownIdle> idle_after(std::span<const MotionWindow> windows) {
    std::vector<KnownIdle> known(windows.size());
    KnownIdle next;
    for (std::size_t k = windows.size(); k-- > 0;) {
        known[k] = next;
        next = shows_idle(windows[k]) ? KnownIdle{&windows[k]} : next;
    }
    return known;
}

bool may_be_placed(const MotionWindow& window) {
    return window.place == ToolPlace::unknown && window.has_spindle_current && window.turns_steadily();
}

void place_by_current(std::span<MotionWindow> windows, const IdleTolerance& tolerance) {
    const std::vector<KnownIdle> before = idle_before(windows);
    const std::vector<KnownIdle> after = idle_after(windows);
    std::vector<ToolPlace> places(windows.size());
    for (std::size_t k = 0; k < windows.size(); ++k) {
        const MotionWindow& window = windows[k];
        places[k] = window.place;
        double idle_A = -std::numeric_limits<double>::infinity();
        for (const KnownIdle& idle : {before[k], after[k]}) {
            idle_A = idle.is_for(window) ? std::max(idle_A, idle.current_A()) : idle_A;
        }
        if (may_be_placed(window) && std::isfinite(idle_A)) {
            const bool is_idle = std::abs(window.spindle_current_A) <= idle_A + tolerance.of_A(window);
            places[k] = is_idle ? ToolPlace::in_air : ToolPlace::in_cut;
        }
    }
    for (std::size_t k = 0; k < windows.size(); ++k) {
        windows[k].place = places[k];
    }
}

/// Where no air is certain: the smallest current of the recording, if it is the idle current of the file, and if there
/// are larger ones. Else the whole recording may be one light cut.
bool presume_air(std::span<MotionWindow> windows, const estimation::SpindleDriveParameters<float>& spindle,
                 const IdleTolerance& tolerance) {
    MotionWindow* quietest = nullptr;
    for (MotionWindow& window : windows) {
        if (may_be_placed(window) &&
            (quietest == nullptr || std::abs(window.spindle_current_A) < std::abs(quietest->spindle_current_A))) {
            quietest = &window;
        }
    }
    if (quietest == nullptr || !(is_plausible_idle(spindle, *quietest) ||
                                 is_plausible_idle(spindle, with_spindle_current_times(*quietest, -1.0)))) {
        return false;
    }
    const double largest_idle_A = std::abs(quietest->spindle_current_A) + tolerance.of_A(*quietest);
    const bool is_quieter = std::any_of(windows.begin(), windows.end(), [&](const MotionWindow& window) {
        return may_be_placed(window) && std::abs(window.spindle_current_A) > largest_idle_A;
    });
    quietest->place = is_quieter ? ToolPlace::in_air : ToolPlace::unknown;
    return is_quieter;
}

}  // namespace

void find_air(std::span<MotionWindow> windows, const firmware::Parameters<float>& parameters, bool spindle_shows) {
    const bool is_any_certain = mark_certain_air(windows);
    const IdleTolerance tolerance(parameters);
    if (spindle_shows && (is_any_certain || presume_air(windows, parameters.machine.spindle, tolerance))) {
        place_by_current(windows, tolerance);
    }
}

}  // namespace millforce::host
