// SPDX-License-Identifier: Apache-2.0
#include "run_report/run_report.hpp"

#include <fmt/format.h>

#include <chrono>

#include "files/atomic_file.hpp"
#include "files/console.hpp"
#include "files/input_error.hpp"
#include "files/printable.hpp"
#include "files/results_folder.hpp"
#include "report/page_origin.hpp"
#include "report/page_parts.hpp"

namespace millforce::host {

namespace {

double monotonic_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string title_of(const RunReport::Settings& settings) {
    switch (settings.kind) {
        case RunKind::run:
            return fmt::format("Run on {}", settings.subject);
        case RunKind::serve:
            return fmt::format("Run behind {}", settings.subject);
        case RunKind::replay:
            break;
    }
    return fmt::format("Replay of {}", std::filesystem::path(settings.subject).filename().string());
}

std::string tool_facts(const firmware::ToolParameters<float>& tool) {
    return fmt::format("{} teeth, Ø{:g} mm, helix {:g}°", tool.teeth, tool.diameter_mm, tool.helix_deg);
}

std::string tool_text(const ToolChoice& choice, const ToolSet& tools) {
    return choice.is_folder() ? fmt::format("{}: {} tools", choice.folder, tools.tools().size())
                              : fmt::format("{}: {}", choice.file, tool_facts(tools.parameters().tool));
}

std::string limit_text(const ToolSet& tools) {
    return tools.tools().empty() ? fmt::format("{:g} N", tools.parameters().tool.tooth_force_limit_N) : std::string();
}

bool is_monitor_only(const ToolSet& tools) {
    return tools.tools().empty() && tools.parameters().tool.monitor_only;
}

}  // namespace

RunReport::RunReport(const Settings& settings, const ToolSet& tools)
    : folder_(results_folder(settings.folder, run_report_file)),
      began_(date_and_time()),
      began_s_(monotonic_s()),
      history_(tools) {
    origin_.title = without_controls(title_of(settings));
    origin_.is_replay = settings.kind == RunKind::replay;
    origin_.is_monitor_only = is_monitor_only(tools);
    origin_.facts = {
        {"Machine", settings.machine},
        {"Tool", tool_text(settings.tools, tools)},
        {"Limit of a tooth (tooth_force_limit_N)", limit_text(tools)},
        {"Samples per second, by the machine's file",
         fmt::format("{:g}", tools.parameters().machine.cnc.sample_rate_hz)},
    };
    const Facts process = facts_of_this_process();
    origin_.facts.insert(origin_.facts.end(), process.begin(), process.end());
}

std::filesystem::path RunReport::write() {
    RunOrigin origin = origin_;
    origin.facts.emplace_back(origin.is_replay ? "Replayed" : "Began", began_);
    origin.facts.emplace_back("The command took", readable_time(monotonic_s() - began_s_));
    std::filesystem::path file_name = folder_ / run_report_file;
    AtomicFile file(file_name);
    file.stream() << run_page_html(history_, origin);
    file.commit();
    return file_name;
}

std::unique_ptr<RunReport> started_report(const RunReport::Settings& settings, const ToolSet& tools) {
    return settings.folder.empty() ? nullptr : std::make_unique<RunReport>(settings, tools);
}

std::unique_ptr<RunRecorder> recorder_of(RunReport* report, RunNotes& notes, RunClock clock) {
    return report == nullptr ? nullptr : std::make_unique<RunRecorder>(report->history(), notes, clock);
}

bool finish_report(RunReport* report, std::FILE* stream) {
    if (report == nullptr) {
        return true;
    }
    try {
        print_line(stream, fmt::format("report: {}", report->write().string()));
        return true;
    } catch (const InputError& error) {
        print_line(stderr, fmt::format("millforce: {}", error.what()));
        return false;
    }
}

}  // namespace millforce::host
