// SPDX-License-Identifier: Apache-2.0
#include "live/mcap_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "files/console.hpp"
#include "files/input_error.hpp"
#include "run_log/estimate_entry.hpp"

namespace millforce::host {

namespace {

constexpr std::uint64_t turns_per_flush = 500;  ///< of 20 ms each

std::ofstream opened(const std::string& name) {
    std::ofstream file(name, std::ios::binary);
    if (!file) {
        throw InputError(fmt::format("{}: {}, expected a file that can be written", name, std::strerror(errno)));
    }
    return file;
}

}  // namespace

McapFile::McapFile(const std::string& name) : name_(name), file_(opened(name)), telemetry_(file_) {}

void McapFile::on_sample(const Telemetry& telemetry) {
    if (!has_failed_ && telemetry.unix_us >= next_row_us_) {
        next_row_us_ = telemetry.unix_us + run_log_interval_us;
        telemetry_.add(telemetry);
    }
}

void McapFile::on_event(const TelemetryEvent& event) {
    if (!has_failed_) {
        telemetry_.add(event);
    }
}

void McapFile::on_turn() {
    if (++turns_ % turns_per_flush == 0 && !has_failed_) {
        telemetry_.flush();
        look_for_failure();
    }
}

void McapFile::on_end() {
    if (!has_failed_) {
        telemetry_.finish();
        look_for_failure();
    }
}

void McapFile::look_for_failure() {
    if (!file_) {
        has_failed_ = true;
        print_line(stderr, fmt::format("millforce: {}: could not be written: the file ends here", name_));
    }
}

}  // namespace millforce::host
