// SPDX-License-Identifier: Apache-2.0
#include "daemon/journal.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstring>

#include "files/console.hpp"
#include "files/input_error.hpp"
#include "run_log/candump_line.hpp"
#include "run_log/estimate_line.hpp"
#include "run_log/local_line.hpp"

namespace millforce::host {

namespace {
constexpr auto writing_period = std::chrono::milliseconds(20);
}

Journal::File Journal::opened(const std::string& name) {
    if (name.empty()) {
        return nullptr;
    }
    File file(std::fopen(name.c_str(), "we"));
    if (file == nullptr) {
        throw InputError(fmt::format("{}: {}, expected a file that can be written", name, std::strerror(errno)));
    }
    return file;
}

Journal::Journal(const JournalSettings& settings)
    : settings_(settings), record_(opened(settings.record_file)), log_(opened(settings.log_file)) {
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
        write_all();
    }
    write_all();
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
        if (*file != nullptr && std::fflush(file->get()) != 0) {
            note_failure(*file);
        }
    }
}

void Journal::note_failure(const File& file) {
    failed_file_ = &file == &record_ ? settings_.record_file : settings_.log_file;
}

void Journal::write_record() {
    for (RecordEntry entry; record_entries_.pop(entry);) {
        if (entry.lost_before != told_lost_) {
            put(record_, fmt::format("# {} frames are missing here: the recorder was too slow\n",
                                     entry.lost_before - told_lost_));
            told_lost_ = entry.lost_before;
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
        const std::string list = condition_list(entry);
        print_line(stderr, fmt::format("millforce: {}: {}", settings_.interface, list.empty() ? "all is well" : list));
    } else if (settings_.status_line) {
        print_line(stdout, fmt::format("{} {}", settings_.interface, status_line(entry)));
    }
}

void Journal::put(const File& file, const std::string& text) {
    if (file != nullptr && std::fwrite(text.data(), 1, text.size(), file.get()) != text.size()) {
        note_failure(file);
    }
}

void Journal::finish() {
    if (!writer_.joinable()) {
        return;
    }
    ended_.store(true);
    writer_.join();
    if (const std::uint64_t unheard = lost_records_ - told_lost_; unheard > 0) {
        put(record_, fmt::format("# {} frames are missing here: the recorder was too slow\n", unheard));
    }
    flush_all();
}

}  // namespace millforce::host
