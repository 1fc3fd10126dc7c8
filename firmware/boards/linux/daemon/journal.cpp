// SPDX-License-Identifier: Apache-2.0
#include "daemon/journal.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <new>

#include "daemon/service.hpp"
#include "files/console.hpp"
#include "run_log/candump_line.hpp"
#include "run_log/estimate_line.hpp"
#include "run_log/local_line.hpp"

namespace millforce::host {

namespace {

constexpr auto writing_period = std::chrono::milliseconds(20);

std::unique_ptr<LogFile> opened(const std::string& name, const char* missing) {
    return name.empty() ? nullptr : std::make_unique<LogFile>(name, missing);
}

}  // namespace

Journal::Journal(const JournalSettings& settings)
    : settings_(settings),
      record_(opened(settings.record_file, "# {} lines are missing here: the file could not be written\n")),
      log_(opened(settings.log_file, R"({{"type":"missing","lines":{}}})"
                                     "\n")) {
    writer_ = std::thread([this] { run(); });
}

Journal::~Journal() {
    finish();
}

void Journal::record(const hal::CanFrame& frame, std::uint64_t unix_us) {
    push({unix_us, 0, frame});
}

void Journal::record(const hal::DriveSample& beside_bus, std::uint64_t unix_us) {
    push({unix_us, 0, beside_bus});
}

void Journal::push(const RecordEntry& entry) {
    if (record_ == nullptr) {
        return;
    }
    RecordEntry numbered = entry;
    numbered.lost_before = lost_records_.load(std::memory_order_relaxed);
    if (!record_entries_.push(numbered)) {
        lost_records_.fetch_add(1, std::memory_order_relaxed);
    }
}

void Journal::estimate(const EstimateEntry& entry) {
    if (log_ != nullptr && !estimates_.push(entry)) {
        lost_entries_.fetch_add(1, std::memory_order_relaxed);
    }
}

void Journal::status(const StatusEntry& entry) {
    if (!statuses_.push(entry)) {
        lost_entries_.fetch_add(1, std::memory_order_relaxed);
    }
}

void Journal::run() {
    while (!ended_.load()) {
        std::this_thread::sleep_for(writing_period);
        turn();
    }
    turn();
}

/// Without memory the files lack something, and the controller goes on.
void Journal::turn() {
    try {
        write_all();
        reopen_where_asked();
    } catch (const std::bad_alloc&) {
        lost_entries_.fetch_add(1, std::memory_order_relaxed);
    }
}

void Journal::write_all() {
    write_record();
    for (EstimateEntry entry; estimates_.pop(entry);) {
        put(log_, json_line(entry, settings_.forces));
    }
    for (StatusEntry entry; statuses_.pop(entry);) {
        write_status(entry);
    }
    flush_all();
}

/// Where a disk is full it shows here.
void Journal::flush_all() {
    for (const File* file : {&record_, &log_}) {
        const int error = *file != nullptr ? (*file)->flush() : 0;
        if (error != 0 && (*file)->failures() == 1) {
            print_line(stderr, fmt::format("millforce: {}: {}: lines are missing until it can be written",
                                           (*file)->name(), std::strerror(error)));
        }
    }
}

std::string Journal::failed_file() const {
    for (const File* file : {&record_, &log_}) {
        if (*file != nullptr && (*file)->failures() > 0) {
            return (*file)->name();
        }
    }
    return {};
}

/// Between two lines: the old file ends with a whole one, the new one begins with one.
void Journal::reopen_where_asked() {
    if (!take_reopen_request()) {
        return;
    }
    for (const File* file : {&record_, &log_}) {
        if (const int error = *file != nullptr ? (*file)->reopen() : 0; error != 0) {
            print_line(stderr, fmt::format("millforce: {}: {}: the old file is written on", (*file)->name(),
                                           std::strerror(error)));
        }
    }
}

void Journal::write_record() {
    for (RecordEntry entry; record_entries_.pop(entry);) {
        if (entry.lost_before != reported_lost_) {
            put(record_, fmt::format("# {} frames are missing here: the recorder was too slow\n",
                                     entry.lost_before - reported_lost_));
            reported_lost_ = entry.lost_before;
        }
        if (const auto* frame = std::get_if<hal::CanFrame>(&entry.what)) {
            put(record_, candump_line(*frame, entry.unix_us, settings_.interface));
            ++recorded_;
        } else {
            put(record_, local_line(std::get<hal::DriveSample>(entry.what), entry.unix_us));
        }
    }
}

void Journal::write_status(const StatusEntry& entry) {
    put(log_, json_line(entry));
    if (!entry.is_periodic) {
        const std::string list = entry.conditions.none() ? "all is well" : condition_list(entry);
        notify_service_manager(fmt::format("STATUS={}", list).c_str());
        print_line(stderr, fmt::format("millforce: {}: {}", settings_.interface, list));
        if (settings_.notes != nullptr) {
            settings_.notes->add(entry.unix_us,
                                 entry.conditions.none() ? "Drives and bus are well." : condition_words(entry));
        }
    } else if (settings_.status_line) {
        print_line(stdout, fmt::format("{} {}", settings_.interface, status_line(entry)));
    }
}

void Journal::put(const File& file, const std::string& line) {
    if (file != nullptr) {
        file->add(line);
    }
}

void Journal::finish() {
    if (!writer_.joinable()) {
        return;
    }
    ended_.store(true);
    writer_.join();
    if (const std::uint64_t unheard = lost_records_ - reported_lost_; unheard > 0) {
        put(record_, fmt::format("# {} frames are missing here: the recorder was too slow\n", unheard));
    }
    flush_all();
}

}  // namespace millforce::host
