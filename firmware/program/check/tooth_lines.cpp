// SPDX-License-Identifier: Apache-2.0
#include "check/tooth_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace millforce::host {

namespace {

constexpr const char* teeth_key = "tool.teeth";
constexpr int most_teeth = 24;
constexpr auto per_order = static_cast<std::size_t>(OrderBlock::per_order);

/// The place that all windows of a block share; unknown where they do not.
ToolPlace place_of(const OrderBlock& block, std::span<const MotionWindow> windows) {
    const auto begins_before = [](double time_s, const MotionWindow& window) { return time_s < window.start_s; };
    auto window = std::upper_bound(windows.begin(), windows.end(), block.start_s, begins_before);
    if (window == windows.begin()) {
        return ToolPlace::unknown;
    }
    --window;
    const ToolPlace place = window->place;
    double covered_s = window->end_s();
    for (++window; window != windows.end() && window->start_s < block.end_s; ++window) {
        if (window->place != place) {
            return ToolPlace::unknown;
        }
        covered_s = window->end_s();
    }
    return covered_s >= block.end_s ? place : ToolPlace::unknown;
}

/// The lines of the cut that the air does not have.
class CutLines {
  public:
    CutLines(const OrderSpectrum& cut, const OrderSpectrum& air) : cut_(cut), air_(air) {}

    [[nodiscard]] int highest_order() const { return cut_.highest_order(); }
    /// Power times order at place/8.
    [[nodiscard]] double strength(std::size_t place) const {
        constexpr double clearly_above_air = 4.0;
        const double line = cut_.line(place);
        const bool is_of_air = air_.blocks() > 0 && line < clearly_above_air * air_.power(place);
        return is_of_air ? 0.0 : line * static_cast<double>(place) / OrderBlock::per_order;
    }
    /// The line once per revolution is that of the runout, and of no sum.
    [[nodiscard]] double runout() const { return strength(per_order); }
    /// `but_of`: its multiples are left out; 0: none.
    [[nodiscard]] double sum_of_multiples(int number, int but_of = 0) const {
        double sum = 0.0;
        for (int order = number == 1 ? 2 : number; order <= highest_order(); order += number) {
            const bool is_left_out = but_of > 0 && order % but_of == 0;
            sum += is_left_out ? 0.0 : strength(static_cast<std::size_t>(order) * per_order);
        }
        return sum;
    }
    /// The strongest line that is at least a quarter of an order away from whole ones.
    [[nodiscard]] std::size_t strongest_between() const {
        std::size_t strongest = per_order;
        for (std::size_t place = per_order; place < static_cast<std::size_t>(highest_order()) * per_order; ++place) {
            const std::size_t beyond = place % per_order;
            const bool is_between = beyond >= 2 && beyond <= per_order - 2;
            const bool is_first = strongest % per_order == 0;
            strongest = is_between && (is_first || strength(place) > strength(strongest)) ? place : strongest;
        }
        return strongest;
    }

  private:
    const OrderSpectrum& cut_;
    const OrderSpectrum& air_;
};

bool contradicts(const CutLines& lines, int number, int stated) {
    const double stated_sum = lines.sum_of_multiples(stated) + (stated == 1 ? lines.runout() : 0.0);
    const double sum = lines.sum_of_multiples(number);
    if (number % stated == 0) {
        constexpr double nearly_all = 0.9;
        return number > stated && stated_sum > 0.0 && sum >= nearly_all * stated_sum;
    }
    if (stated % number == 0) {
        const double ratio = static_cast<double>(stated) / number;
        return stated_sum > 0.0 && sum > (0.65 * ratio + 0.3) * stated_sum;
    }
    constexpr double clearly_more = 4.0;
    return lines.sum_of_multiples(number, stated) > clearly_more * lines.sum_of_multiples(stated, number);
}

/// The largest number whose multiples hold most of what the lines hold.
int number_of_teeth(const CutLines& lines) {
    constexpr double most = 0.75;
    const double all = lines.sum_of_multiples(1);
    int number = 2;
    for (int candidate = 2; candidate <= most_teeth; ++candidate) {
        number = lines.sum_of_multiples(candidate) >= most * all ? candidate : number;
    }
    return number;
}

Finding cannot_judge(const std::string& why) {
    return {Severity::note, "the number of teeth is not compared: " + why, teeth_key};
}

Findings wrong_counts(std::size_t place) {
    return {
        {Severity::warning,
         fmt::format("spindle: the cut repeats {:.2f} times per recorded revolution, which no whole number of teeth "
                     "does: wrong counts per revolution, or chatter",
                     static_cast<double>(place) / OrderBlock::per_order),
         "spindle.encoder_counts_per_rev"}};
}

Findings compare_lines(const CutLines& lines, int stated, bool counts_are_proven) {
    const double all = lines.sum_of_multiples(1);
    const std::size_t between = lines.strongest_between();
    if (!counts_are_proven && lines.strength(between) > all + lines.runout()) {
        return wrong_counts(between);
    }
    if (!(all + lines.runout() > 0.0)) {
        return {cannot_judge("no line of a tooth stands out of the noise")};
    }
    if (stated > 1 && lines.runout() > all) {
        return {cannot_judge("the cut repeats once per revolution, by its runout or because a single tooth cuts")};
    }
    bool is_wrong = false;
    for (int number = 2; number <= most_teeth; ++number) {
        is_wrong = is_wrong || contradicts(lines, number, stated);
    }
    if (!is_wrong) {
        return {};
    }
    const int seen = number_of_teeth(lines);
    return {{Severity::warning,
             fmt::format("the cut repeats {} times per revolution, and the tool has {} teeth{}", seen, stated,
                         counts_are_proven ? "" : "; or spindle.encoder_counts_per_rev is wrong"),
             teeth_key}};
}

}  // namespace

Findings check_teeth(const ToothEvidence& evidence, std::span<const MotionWindow> windows,
                     const firmware::ToolParameters<float>& tool) {
    if (evidence.comes_seldom) {
        return {cannot_judge("the spindle's current comes too seldom (spindle.load_period_s)")};
    }
    OrderSpectrum cut;
    OrderSpectrum air;
    double samples_per_rev = 0.0;
    for (const OrderBlock& block : evidence.blocks) {
        const ToolPlace place = place_of(block, windows);
        if (place == ToolPlace::in_cut) {
            cut.add(block);
            samples_per_rev += block.samples_per_rev;
        } else if (place == ToolPlace::in_air) {
            air.add(block);
        }
    }
    const int teeth = tool.teeth;
    if (cut.blocks() < OrderSpectrum::fewest_blocks) {
        return {cannot_judge(fmt::format("it takes {} revolutions in the cut, beside some in air",
                                         OrderSpectrum::fewest_blocks * per_order))};
    }
    if (cut.highest_order() < teeth) {
        return {cannot_judge(fmt::format("{:.2g} samples per tooth; it takes 2.5",
                                         samples_per_rev / static_cast<double>(cut.blocks()) / teeth))};
    }
    return compare_lines(CutLines(cut, air), teeth, evidence.counts_are_proven);
}

}  // namespace millforce::host
