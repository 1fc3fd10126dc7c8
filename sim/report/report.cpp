// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <utility>

#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "report/html_report.hpp"
#include "report/summary.hpp"
#include "report/trace_csv.hpp"

namespace millforce::sim {

namespace {

void make_directory(const std::filesystem::path& directory) {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (!std::filesystem::is_directory(directory)) {
        const std::string reason = error ? error.message() : "there is a file of that name";
        throw host::InputError(
            fmt::format("{}: cannot be made ({}); expected a directory for the report", directory.string(), reason));
    }
}

void write_file(const std::filesystem::path& path, const std::string& text) {
    host::AtomicFile file(path);
    file.stream().write(text.data(), static_cast<std::streamsize>(text.size()));
    file.commit();
}

}  // namespace

std::vector<std::filesystem::path> write_report(const std::filesystem::path& directory, const ScenarioInfo& info,
                                                std::span<const RunResult> runs) {
    make_directory(directory);
    std::vector<std::filesystem::path> written;
    const auto write = [&](const std::string& name, const std::string& text) {
        written.push_back(directory / name);
        write_file(written.back(), text);
    };
    write("summary.json", summary_json(info, runs));
    for (const RunResult& run : runs) {
        write(trace_file_name(run, runs), trace_csv(run));
    }
    write("report.html", report_html(info, runs));
    return written;
}

}  // namespace millforce::sim
