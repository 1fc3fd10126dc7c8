// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "parameters/tool_set.hpp"
#include "run_report/run_history.hpp"
#include "run_report/run_page.hpp"
#include "run_report/run_recorder.hpp"

namespace millforce::host {

inline constexpr const char* run_report_file = "report.html";

enum class RunKind : std::uint8_t { run, serve, replay };

/// The page of a run, from the start of its command to its end.
class RunReport {
  public:
    struct Settings {
        RunKind kind;
        std::string subject;  ///< interface, socket or log
        std::string machine;  ///< file
        ToolChoice tools;
        std::string folder;  ///< for the page; empty: none is wanted
    };
    /// Creates the folder. Throws InputError: the page cannot be written there.
    RunReport(const Settings& settings, const ToolSet& tools);

    [[nodiscard]] RunHistory& history() { return history_; }
    /// Writes the page, whole or not at all, over one that is there. Returns the file. Throws InputError where it
    /// cannot be written.
    std::filesystem::path write();

  private:
    std::filesystem::path folder_;
    std::string began_;
    double began_s_;
    RunOrigin origin_;
    RunHistory history_;
};

/// Null where no folder is given.
[[nodiscard]] std::unique_ptr<RunReport> started_report(const RunReport::Settings& settings, const ToolSet& tools);

/// Fills the report of a live run; null without one. Both outlive it.
[[nodiscard]] std::unique_ptr<RunRecorder> recorder_of(RunReport* report, RunNotes& notes, RunClock clock);

/// Writes the page and says on `stream` where it is; nothing without a report. False, and a line on standard error,
/// where it could not be written: the run is over, and its other files are worth keeping.
[[nodiscard]] bool finish_report(RunReport* report, std::FILE* stream);

}  // namespace millforce::host
