// SPDX-License-Identifier: Apache-2.0
#include "telemetry/telemetry_fields.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "control/cut_state.hpp"

namespace millforce::host {

namespace {

template <typename Name, std::size_t count>
constexpr std::array<std::string_view, count> names_of() {
    std::array<std::string_view, count> names{};
    for (std::size_t k = 0; k < count; ++k) {
        names[k] = name(static_cast<Name>(k));
    }
    return names;
}

constexpr auto state_names = names_of<control::CutState, control::state_count>();
constexpr auto limit_names = names_of<control::Limit, control::limit_count>();
constexpr auto fault_names = names_of<control::Fault, control::fault_count>();
constexpr auto side_names = names_of<estimation::CutSide, estimation::cut_side_count>();
constexpr auto condition_names = names_of<firmware::Condition, firmware::condition_count>();

FieldValue number(float value) {
    return std::isfinite(value) ? FieldValue(value) : FieldValue();
}
FieldValue number_if(bool is_known, float value) {
    return is_known ? number(value) : FieldValue();
}
FieldValue count(std::uint64_t value) {
    return value;
}

FieldValue conditions(const Telemetry& t) {
    std::vector<std::string_view> found;
    for (std::size_t k = 0; k < firmware::condition_count; ++k) {
        if (t.sample.conditions.has(static_cast<firmware::Condition>(k))) {
            found.push_back(condition_names[k]);
        }
    }
    return found;
}

FieldValue spindle_current(const Telemetry& t) {
    return number_if((t.sample.drives.present & hal::mask(hal::Present::spindle_current)) != 0,
                     t.sample.drives.spindle_current_A);
}
template <std::size_t axis>
FieldValue axis_current(const Telemetry& t) {
    return number_if(hal::knows_current(t.sample.drives, axis), t.sample.drives.axis_current_A[axis]);
}
template <std::size_t axis>
FieldValue axis_velocity(const Telemetry& t) {
    return number_if(hal::knows_velocity(t.sample.drives, axis), t.sample.drives.axis_velocity_mm_s[axis]);
}

using Kind = FieldKind;
using Of = const Telemetry&;

constexpr std::array fields{
    TelemetryField{"time_s", "s", "Time of the tick, by the clock of its samples", Kind::number,
                   [](Of t) { return FieldValue(t.time_s); }},
    TelemetryField{
        "state", "", "Where the tool stands in relation to the cut", Kind::word,
        [](Of t) { return FieldValue(state_names[t.sample.tick.feed_override.state % control::state_count]); },
        state_names},
    TelemetryField{"limit", "", "What holds the override down", Kind::word,
                   [](Of t) { return FieldValue(limit_names[t.sample.tick.limit % control::limit_count]); },
                   limit_names},
    TelemetryField{
        "fault", "", "Why the controller has given up, latched", Kind::word,
        [](Of t) { return FieldValue(fault_names[t.sample.tick.feed_override.fault % control::fault_count]); },
        fault_names},
    TelemetryField{"hold", "", "The feed is held, whatever the override says", Kind::flag,
                   [](Of t) { return FieldValue(t.sample.is_held); }},
    TelemetryField{"override", "1", "Multiple of the programmed feed", Kind::number,
                   [](Of t) { return number(t.sample.tick.feed_override.ratio); }},
    TelemetryField{"tangential_force_N", "N", "Tangential force, averaged over a tooth period", Kind::number,
                   [](Of t) { return number(t.sample.tick.tangential_force_N); }},
    TelemetryField{"feed_force_N", "N", "Force against the feed, averaged over a tooth period", Kind::number,
                   [](Of t) { return number(t.sample.tick.feed_force_N); }},
    TelemetryField{"radial_immersion", "1", "Radial depth of cut as a multiple of the tool's radius, 0 to 2",
                   Kind::number, [](Of t) { return number(t.sample.tick.radial_immersion); }},
    TelemetryField{"radial_immersion_sd", "1", "Standard deviation of the radial immersion", Kind::number,
                   [](Of t) { return number(t.sample.tick.radial_immersion_sd); }},
    TelemetryField{"axial_depth_mm", "mm", "Axial depth of cut", Kind::number,
                   [](Of t) { return number(t.sample.tick.axial_depth_mm); }},
    TelemetryField{"axial_depth_sd_mm", "mm", "Standard deviation of the axial depth of cut", Kind::number,
                   [](Of t) { return number(t.sample.tick.axial_depth_sd_mm); }},
    TelemetryField{"peak_force_N", "N", "Largest total force within a revolution: the load", Kind::number,
                   [](Of t) { return number(t.sample.tick.has_tooth_force() ? t.shown.peak_N : NAN); }},
    TelemetryField{"force_limit_N", "N", "Total force at which one tooth is at its limit: the threshold", Kind::number,
                   [](Of t) { return number(t.shown.limit_N); }},
    TelemetryField{"tooth_force_N", "N", "Largest force on one tooth, or its upper bound", Kind::number,
                   [](Of t) { return number(t.sample.tick.tooth_force_N); }},
    TelemetryField{"tooth_force_limit_N", "N", "Largest force that one tooth may carry, of the tool's file",
                   Kind::number, [](Of t) { return number(t.tooth_force_limit_N); }},
    TelemetryField{"cut_side", "", "Side of the cut that the forces fit better, or the declared one", Kind::word,
                   [](Of t) {
                       const firmware::TickRecord& tick = t.sample.tick;
                       return tick.has_side() ? FieldValue(std::string_view(name(tick.side))) : FieldValue();
                   },
                   side_names},
    TelemetryField{"law_misfit", "1",
                   "How badly the tool's law explains the forces: one window in 20 of the right law exceeds 3.8, and "
                   "above 16 there is no immersion",
                   Kind::number, [](Of t) { return number(t.sample.tick.law_misfit); }},
    TelemetryField{"runout_um", "µm",
                   "By how much the chip of the tooth that stands out furthest is thicker than the mean one, at most; "
                   "runout_um of the tool's file until a cut shows it",
                   Kind::number, [](Of t) { return number(t.sample.tick.runout_um); }},
    TelemetryField{"tool", "", "Number of the tool that the override is for; 0: one tool, or not known", Kind::count,
                   [](Of t) { return count(t.sample.tool); }},
    TelemetryField{"ticks", "", "Ticks of the controller since the run began", Kind::counter,
                   [](Of t) { return count(t.sample.tick.feed_override.heartbeat); }},
    TelemetryField{"spindle_current_A", "A", "Current of the spindle's drive", Kind::number, spindle_current},
    TelemetryField{"x_current_A", "A", "Current of the x axis' drive", Kind::number, axis_current<0>},
    TelemetryField{"y_current_A", "A", "Current of the y axis' drive", Kind::number, axis_current<1>},
    TelemetryField{"z_current_A", "A", "Current of the z axis' drive", Kind::number, axis_current<2>},
    TelemetryField{"x_velocity_mm_s", "mm/s", "Velocity of the tool relative to the workpiece along x", Kind::number,
                   axis_velocity<0>},
    TelemetryField{"y_velocity_mm_s", "mm/s", "Velocity of the tool relative to the workpiece along y", Kind::number,
                   axis_velocity<1>},
    TelemetryField{"z_velocity_mm_s", "mm/s", "Velocity of the tool relative to the workpiece along z", Kind::number,
                   axis_velocity<2>},
    TelemetryField{"programmed_feed_mm_s", "mm/s", "F of the program's block in work", Kind::number,
                   [](Of t) {
                       const float feed_mm_s = t.sample.program.programmed_feed_mm_s;
                       return number_if(feed_mm_s > 0.0F, feed_mm_s);
                   }},
    TelemetryField{"commanded_speed_rad_s", "rad/s", "Speed that the spindle's drive is told", Kind::number,
                   [](Of t) {
                       const float speed_rad_s = t.sample.program.commanded_speed_rad_s;
                       return number_if(speed_rad_s > 0.0F, speed_rad_s);
                   }},
    TelemetryField{"operator_override", "1", "The operator's override", Kind::number,
                   [](Of t) { return number(t.sample.program.operator_override); }},
    TelemetryField{"rapid", "", "A rapid move is in work", Kind::flag,
                   [](Of t) { return FieldValue(t.sample.program.rapid); }},
    TelemetryField{"feed_hold", "", "The operator or the CNC holds the feed", Kind::flag,
                   [](Of t) { return FieldValue(t.sample.program.feed_hold); }},
    TelemetryField{"program_line", "", "Line of the program's block in work; 0: not known", Kind::count,
                   [](Of t) { return count(t.sample.program.line); }},
    TelemetryField{"conditions", "", "What is wrong, or not yet right, on the bus or on this computer", Kind::words,
                   conditions, condition_names},
    TelemetryField{"samples_lost", "", "Ticks that are missing in this telemetry: its reader was too slow",
                   Kind::counter, [](Of t) { return count(t.lost); }},
};

struct AsJson {
    std::string operator()(std::monostate) const { return {}; }
    std::string operator()(float value) const { return fmt::format("{}", value); }
    std::string operator()(double value) const { return fmt::format("{:.6f}", value); }
    std::string operator()(std::uint64_t value) const { return fmt::format("{}", value); }
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::string_view word) const { return fmt::format(R"("{}")", word); }
    std::string operator()(const std::vector<std::string_view>& words) const {
        std::string text;
        for (const std::string_view word : words) {
            text += fmt::format(R"({}"{}")", text.empty() ? "" : ",", word);
        }
        return "[" + text + "]";
    }
};

std::string joined(std::span<const std::string_view> words) {
    std::string text;
    for (const std::string_view word : words) {
        text += fmt::format("{}`{}`", text.empty() ? "" : ", ", word);
    }
    return text;
}

}  // namespace

std::span<const TelemetryField> telemetry_fields() {
    return fields;
}

std::string json_value(const FieldValue& value) {
    return std::visit(AsJson{}, value);
}

std::string telemetry_json(const Telemetry& telemetry) {
    std::string text;
    for (const TelemetryField& field : fields) {
        if (const std::string value = json_value(field.value(telemetry)); !value.empty()) {
            text += fmt::format(R"({}"{}":{})", text.empty() ? "" : ",", field.name, value);
        }
    }
    return "{" + text + "}";
}

std::string telemetry_table() {
    std::string text = "| field | unit | what it is |\n|---|---|---|\n";
    for (const TelemetryField& field : fields) {
        text += fmt::format("| `{}` | {} | {}{}{} |\n", field.name, field.unit, field.meaning,
                            field.words.empty() ? "" : ": ", joined(field.words));
    }
    return text;
}

}  // namespace millforce::host
