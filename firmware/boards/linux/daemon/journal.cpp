// SPDX-License-Identifier: Apache-2.0
#include "daemon/journal.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstring>

#include "daemon/candump_line.hpp"
#include "daemon/json_lines.hpp"
#include "files/input_error.hpp"

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
    if (record_ != nullptr && !frames_.push({unix_us, lost_frames_.load(std::memory_order_relaxed), frame})) {
        lost_frames_.fetch_add(1, std::memory_order_relaxed);
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
    write_frames();
    for (EstimateEntry entry; estimates_.pop(entry);) {
        put(log_, json_line(entry, settings_.total_force));
    }
    for (StatusEntry entry; statuses_.pop(entry);) {
        write_status(entry);
    }
    if (record_ != nullptr) {
        std::fflush(record_.get());
    }
    if (log_ != nullptr) {
        std::fflush(log_.get());
    }
}

void Journal::write_frames() {
    for (FrameEntry entry; frames_.pop(entry);) {
        if (entry.lost_before != told_lost_) {
            put(record_, fmt::format("# {} frames are missing here: the recorder was too slow\n",
                                     entry.lost_before - told_lost_));
            told_lost_ = entry.lost_before;
        }
        put(record_, candump_line(entry.frame, entry.unix_us, settings_.interface));
        ++recorded_;
    }
}

void Journal::write_status(const StatusEntry& entry) {
    put(log_, json_line(entry));
    if (!entry.is_periodic) {
        const std::string list = condition_list(entry);
        fmt::print(stderr, "millforce: {}: {}\n", settings_.interface, list.empty() ? "all is well" : list);
    } else if (settings_.status_line) {
        fmt::print("{} {}\n", settings_.interface, status_line(entry));
        std::fflush(stdout);
    }
}

void Journal::put(const File& file, const std::string& text) {
    if (file != nullptr && std::fwrite(text.data(), 1, text.size(), file.get()) != text.size()) {
        write_failed_ = true;
    }
}

void Journal::finish() {
    if (!writer_.joinable()) {
        return;
    }
    ended_.store(true);
    writer_.join();
    if (const std::uint64_t unheard = lost_frames_ - told_lost_; unheard > 0) {
        put(record_, fmt::format("# {} frames are missing here: the recorder was too slow\n", unheard));
    }
    for (const File* file : {&record_, &log_}) {
        write_failed_ = write_failed_ || (*file != nullptr && std::fflush(file->get()) != 0);
    }
}

}  // namespace millforce::host
