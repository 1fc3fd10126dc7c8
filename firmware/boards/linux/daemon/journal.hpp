// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <variant>

#include "daemon/log_file.hpp"
#include "daemon/status_lines.hpp"
#include "run_log/estimate_entry.hpp"
#include "run_log/spsc_ring.hpp"
#include "run_log/tool_forces.hpp"
#include "run_report/run_notes.hpp"

namespace millforce::host {

struct JournalSettings {
    std::string interface;
    std::string record_file;    ///< candump log of every frame, with local_line()s between; empty: none
    std::string log_file;       ///< JSON lines; empty: none
    bool status_line = false;   ///< on standard output, once a second
    ToolForces forces;          ///< for the log
    RunNotes* notes = nullptr;  ///< of conditions as they come and go; outlive the journal
};

/// The files of a run, written by a separate thread: the real-time thread hands over without waiting. Entries that did
/// not fit are counted, noted in the files where they are missing, and reported at the end; so are lines that a full
/// disk did not take, and standard error says so at once. On SIGUSR1 both files are opened again by their names.
class Journal {
  public:
    /// Opens the files; throws InputError.
    explicit Journal(const JournalSettings& settings);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    void record(const hal::CanFrame& frame, std::uint64_t unix_us);
    /// What a source beside the bus gave for the SYNC that was recorded last.
    void record(const hal::DriveSample& beside_bus, std::uint64_t unix_us);
    void estimate(const EstimateEntry& entry);
    void status(const StatusEntry& entry);

    /// Writes what is left and closes the files.
    void finish();
    /// Frames and entries that did not fit; after finish().
    [[nodiscard]] std::uint64_t lost() const { return lost_records_ + lost_entries_; }
    [[nodiscard]] std::uint64_t recorded() const { return recorded_; }
    /// The file that could not be written, if one could not; after finish().
    [[nodiscard]] std::string failed_file() const;

  private:
    using File = std::unique_ptr<LogFile>;
    struct RecordEntry {
        std::uint64_t unix_us = 0;
        std::uint64_t lost_before = 0;
        std::variant<hal::CanFrame, hal::DriveSample> what{};
    };

    void run();
    void turn();
    void write_all();
    void reopen_where_asked();
    void push(const RecordEntry& entry);
    void write_record();
    void write_status(const StatusEntry& entry);
    static void put(const File& file, const std::string& line);
    void flush_all();

    JournalSettings settings_;
    File record_;
    File log_;
    SpscRing<RecordEntry, 1U << 15U> record_entries_{};
    SpscRing<EstimateEntry, 1U << 10U> estimates_{};
    SpscRing<StatusEntry, 1U << 6U> statuses_{};
    std::atomic<std::uint64_t> lost_records_{0};
    std::atomic<std::uint64_t> lost_entries_{0};
    std::uint64_t reported_lost_ = 0;
    std::uint64_t recorded_ = 0;
    std::atomic<bool> ended_{false};
    std::thread writer_{};
};

}  // namespace millforce::host
