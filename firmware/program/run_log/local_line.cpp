// SPDX-License-Identifier: Apache-2.0
#include "run_log/local_line.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <iterator>

namespace millforce::host {

namespace {

constexpr std::string_view beginning = "#local (";
constexpr std::array<std::string_view, hal::axis_count> current_keys{"x_current_A", "y_current_A", "z_current_A"};
constexpr std::array<std::string_view, hal::axis_count> velocity_keys{"x_velocity_mm_s", "y_velocity_mm_s",
                                                                      "z_velocity_mm_s"};

bool has(const hal::DriveSample& sample, hal::Present quantity) {
    return (sample.present & hal::mask(quantity)) != 0;
}

/// The whole text, and a finite number.
template <typename Number>
bool read_number(std::string_view text, Number& number) {
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    return error == std::errc{} && rest == end && std::isfinite(static_cast<double>(number));
}

bool read_axis(std::string_view key, std::string_view value, hal::DriveSample& sample) {
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        if (key == current_keys[axis] && read_number(value, sample.axis_current_A[axis])) {
            hal::set_known(sample, axis, true, hal::knows_velocity(sample, axis));
            return true;
        }
        if (key == velocity_keys[axis] && read_number(value, sample.axis_velocity_mm_s[axis])) {
            hal::set_known(sample, axis, hal::knows_current(sample, axis), true);
            return true;
        }
    }
    return false;
}

bool read_value(std::string_view key, std::string_view value, hal::DriveSample& sample) {
    if (key == "spindle_current_A" && read_number(value, sample.spindle_current_A)) {
        hal::set_present(sample, hal::Present::spindle_current);
        return true;
    }
    if (key == "spindle_count" && read_number(value, sample.spindle_count)) {
        hal::set_present(sample, hal::Present::spindle_count);
        return true;
    }
    if ((key == "spindle_index_count" && read_number(value, sample.spindle_index_count)) ||
        (key == "spindle_index_number" && read_number(value, sample.spindle_index_number))) {
        return true;
    }
    return read_axis(key, value, sample);
}

}  // namespace

std::string local_line(const hal::DriveSample& sample, std::uint64_t unix_us) {
    std::string line = fmt::format("{}{:010}.{:06})", beginning, unix_us / 1'000'000, unix_us % 1'000'000);
    const auto put = [&line](bool is_known, std::string_view key, auto value) {
        if (is_known) {
            fmt::format_to(std::back_inserter(line), " {}={}", key, value);
        }
    };
    put(has(sample, hal::Present::spindle_current), "spindle_current_A", sample.spindle_current_A);
    put(has(sample, hal::Present::spindle_count), "spindle_count", sample.spindle_count);
    put(sample.spindle_index_number != 0, "spindle_index_count", sample.spindle_index_count);
    put(sample.spindle_index_number != 0, "spindle_index_number", sample.spindle_index_number);
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        put(hal::knows_current(sample, axis), current_keys[axis], sample.axis_current_A[axis]);
        put(hal::knows_velocity(sample, axis), velocity_keys[axis], sample.axis_velocity_mm_s[axis]);
    }
    return line + '\n';
}

bool is_local_line(std::string_view line) {
    return line.starts_with(beginning);
}

bool read_local_line(std::string_view line, hal::DriveSample& sample) {
    sample = {};
    if (line.ends_with('\r')) {
        line.remove_suffix(1);
    }
    std::size_t place = line.find(')');
    if (!is_local_line(line) || place == std::string_view::npos) {
        return false;
    }
    for (++place; place < line.size() && line[place] == ' ';) {
        const std::size_t end = std::min(line.find(' ', place + 1), line.size());
        const std::string_view word = line.substr(place + 1, end - place - 1);
        const std::size_t equals = word.find('=');
        if (equals == std::string_view::npos || !read_value(word.substr(0, equals), word.substr(equals + 1), sample)) {
            return false;
        }
        place = end;
    }
    return place == line.size();
}

}  // namespace millforce::host
