// SPDX-License-Identifier: Apache-2.0
#include "remote/controller_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "files/input_error.hpp"
#include "files/nearest_name.hpp"
#include "files/printable.hpp"
#include "loop/override_source.hpp"
#include "parameters/parameter_table.hpp"
#include "remote/parameters_json.hpp"
#include "report/json_writer.hpp"

namespace millforce::sim {

namespace {

using nlohmann::json;

constexpr int float_digits = std::numeric_limits<float>::max_digits10;
constexpr int double_digits = std::numeric_limits<double>::digits10;

struct EstimateKey {
    const char* name;
    double TracePoint::*value;
};
constexpr std::array<EstimateKey, 9> estimate_keys{{
    {"tangential_force_N", &TracePoint::tangential_force_N},
    {"feed_force_N", &TracePoint::feed_force_N},
    {"radial_immersion", &TracePoint::radial_immersion},
    {"radial_immersion_sd", &TracePoint::radial_immersion_sd},
    {"axial_depth_mm", &TracePoint::axial_depth_mm},
    {"axial_depth_sd_mm", &TracePoint::axial_depth_sd_mm},
    {"tooth_force_N", &TracePoint::tooth_force_N},
    {"peak_force_N", &TracePoint::peak_force_N},
    {"force_limit_N", &TracePoint::force_limit_N},
}};

// ---- what is sent

host::JsonWriter message(std::string_view type) {
    host::JsonWriter out;
    out.begin_object().key("type").text(type);
    return out;
}

void write_number(host::JsonWriter& out, std::string_view key, double value, bool is_known = true) {
    out.key(key).number(is_known ? value : host::no_estimate, double_digits);
}
void write_float(host::JsonWriter& out, std::string_view key, float value, bool is_known = true) {
    out.key(key).number(is_known ? static_cast<double>(value) : host::no_estimate, float_digits);
}

void write_drives(host::JsonWriter& out, const hal::DriveSample& sample) {
    const auto has = [&](hal::Present quantity) { return (sample.present & hal::mask(quantity)) != 0; };
    write_float(out, "spindle_current_A", sample.spindle_current_A, has(hal::Present::spindle_current));
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        write_float(out, fmt::format("{}_current_A", host::axis_tables[axis]), sample.axis_current_A[axis],
                    hal::knows_current(sample, axis));
    }
    const bool has_sensor = has(hal::Present::force_sensor);
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        write_float(out, fmt::format("{}_velocity_mm_s", host::axis_tables[axis]), sample.axis_velocity_mm_s[axis],
                    hal::knows_velocity(sample, axis) || (has_sensor && axis < sample.force_N.size()));
    }
    write_float(out, "fx_N", sample.force_N[0], has_sensor);
    write_float(out, "fy_N", sample.force_N[1], has_sensor);
}

// ---- what is received

[[noreturn]] void refuse(std::string_view message_name, const std::string& what) {
    throw host::InputError(fmt::format("{}: {}", message_name, what));
}

/// One object of a line, whose keys are all known by the time it is closed.
class Message {
  public:
    Message(std::string_view line, std::string name) : name_(std::move(name)) {
        value_ = json::parse(line, nullptr, false);
        if (!value_.is_object()) {
            refuse(name_, fmt::format("'{}', expected a JSON object in one line", host::printable(line)));
        }
    }

    /// Null where the key is missing.
    const json* find(const char* key) {
        known_.emplace_back(key);
        const auto found = value_.find(key);
        return found == value_.end() ? nullptr : &*found;
    }
    const json& require(const char* key, const char* expected) {
        const json* value = find(key);
        if (value == nullptr) {
            refuse(name_, fmt::format("no key {}, expected {}", key, expected));
        }
        return *value;
    }
    [[noreturn]] void fail(const char* key, const json& value, const std::string& expected) const {
        refuse(name_, fmt::format("{} is {}, expected {}", key, shown(value), expected));
    }
    void reject_unknown_keys() const {
        for (const auto& [key, value] : value_.items()) {
            if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
                const std::string nearest = host::nearest_name(key, known_);
                refuse(name_, fmt::format("unknown key {}{}", host::printable(key),
                                          nearest.empty() ? "" : fmt::format(", did you mean {}?", nearest)));
            }
        }
    }

  private:
    [[nodiscard]] static std::string shown(const json& value) {
        return value.is_structured() ? value.type_name()
                                     : host::printable(value.dump(-1, ' ', true, json::error_handler_t::replace));
    }

    std::string name_;
    json value_;
    std::vector<std::string> known_;
};

float read_override(Message& answer, const firmware::CncParameters<float>& limits) {
    const std::string expected = fmt::format("a number from {:g} to {:g}", limits.override_min, limits.override_max);
    const json& value = answer.require("override", expected.c_str());
    if (!value.is_number()) {
        answer.fail("override", value, expected);
    }
    const auto ratio = static_cast<float>(value.get<double>());
    if (!(ratio >= limits.override_min && ratio <= limits.override_max)) {
        answer.fail("override", value, expected);
    }
    return ratio;
}

bool read_hold(Message& answer) {
    const json* value = answer.find("hold");
    if (value != nullptr && !value->is_boolean()) {
        answer.fail("hold", *value, "true or false");
    }
    return value != nullptr && value->get<bool>();
}

std::optional<TracePoint> read_estimate(Message& answer) {
    TracePoint estimate;
    bool is_there = false;
    for (const EstimateKey& key : estimate_keys) {
        const json* value = answer.find(key.name);
        if (value == nullptr) {
            continue;
        }
        is_there = true;
        if (!value->is_null() && !value->is_number()) {
            answer.fail(key.name, *value, "a number or null");
        }
        estimate.*key.value = value->is_number() ? value->get<double>() : host::no_estimate;
    }
    return is_there ? std::optional(estimate) : std::nullopt;
}

void require_whole(Message& of, const char* key, const json& value, std::uint64_t expected) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() != expected) {
        of.fail(key, value, std::to_string(expected));
    }
}

}  // namespace

std::string hello_message(const Scenario& scenario) {
    host::JsonWriter out = message("hello");
    out.key("version").integer(controller_protocol_version);
    out.key("scenario").text(scenario.name);
    out.key("seed").unsigned_integer(scenario.seed);
    out.key("machine");
    write_parameters(out, scenario.parameters, firmware::ParameterFile::machine);
    out.key("tool");
    write_parameters(out, scenario.parameters, firmware::ParameterFile::tool);
    return out.end_object().str();
}

std::string read_ready(std::string_view line) {
    Message ready(line, "the answer to hello");
    const json& type = ready.require("type", "\"ready\"");
    if (type != "ready") {
        ready.fail("type", type, "\"ready\"");
    }
    require_whole(ready, "version", ready.require("version", "the protocol's version"), controller_protocol_version);
    const json& name = ready.require("name", "the controller's name");
    const std::vector<std::string> taken = controller_names();
    if (!name.is_string() || name.get<std::string>().empty() ||
        std::find(taken.begin(), taken.end(), name.get<std::string>()) != taken.end()) {
        ready.fail("name", name, "a text, and not the name of one of millforce's own controllers");
    }
    ready.reject_unknown_keys();
    return host::printable(name.get<std::string>());
}

std::string sample_message(const SampleOfRun& at) {
    host::JsonWriter out = message("sample");
    out.key("sample").unsigned_integer(at.number);
    write_number(out, "time_s", at.counts.time_s());
    write_number(out, "spindle_angle_rad", at.counts.angle_rad(), host::ContinuousCounts::has_count(at.sample));
    write_number(out, "spindle_index_angle_rad", at.counts.index_angle_rad(at.sample),
                 host::ContinuousCounts::has_index(at.sample));
    write_drives(out, at.sample);
    write_float(out, "programmed_feed_mm_s", at.program.programmed_feed_mm_s);
    out.key("rapid").boolean(at.program.rapid);
    out.key("line").integer(at.program.line);
    write_float(out, "distance_to_go_mm", at.program.distance_to_go_mm);
    write_float(out, "commanded_speed_rad_s", at.program.commanded_speed_rad_s);
    out.key("estimate").begin_object();
    for (const EstimateKey& key : estimate_keys) {
        out.key(key.name).number(at.estimate.*key.value, float_digits);
    }
    return out.end_object().end_object().str();
}

ControllerAnswer read_answer(std::string_view line, std::uint64_t number,
                             const firmware::CncParameters<float>& limits) {
    Message message(line, fmt::format("the answer to sample {}", number));
    ControllerAnswer answer;
    answer.override_ratio = read_override(message, limits);
    answer.hold = read_hold(message);
    answer.estimate = read_estimate(message);
    if (const json* echo = message.find("sample"); echo != nullptr) {
        require_whole(message, "sample", *echo, number);
    }
    message.reject_unknown_keys();
    return answer;
}

void copy_estimate(const TracePoint& from, TracePoint& to) {
    for (const EstimateKey& key : estimate_keys) {
        to.*key.value = from.*key.value;
    }
}

std::string end_message(const RunFigures& figures) {
    host::JsonWriter out = message("end");
    out.key("finished").boolean(figures.finished);
    out.key("time_s").number(figures.time_s, float_digits);
    out.key("peak_over_limit").number(figures.peak_over_limit, float_digits);
    out.key("teeth_broken").integer(figures.teeth_broken);
    out.key("mean_override").number(figures.mean_override, float_digits);
    return out.end_object().str();
}

std::string error_message(std::string_view what) {
    return message("error").key("message").text(what).end_object().str();
}

}  // namespace millforce::sim
