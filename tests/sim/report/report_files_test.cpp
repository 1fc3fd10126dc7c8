// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "files/input_error.hpp"
#include "firmware/program/report/json_check.hpp"
#include "report/report.hpp"
#include "report/trace_csv.hpp"
#include "synthetic_run.hpp"

using namespace millforce::host;
using namespace millforce::sim;

namespace {

std::string content_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_GROUP(ReportFiles) {
    std::filesystem::path directory;
    ScenarioInfo info = synthetic::pocket_scenario();
    std::vector<RunResult> runs;

    void setup() override {
        directory = std::filesystem::temp_directory_path() / ("millforce_report_" + std::to_string(::getpid()));
        std::filesystem::remove_all(directory);
        for (const char* controller : {"millforce", "constant"}) {
            RunResult run;
            run.controller = controller;
            run.trace.resize(3);
            runs.push_back(run);
        }
    }

    void teardown() override {
        std::filesystem::remove_all(directory);
    }

    std::string error_of_writing_to(const std::filesystem::path& target) {
        try {
            write_report(target, info, runs);
        } catch (const InputError& error) {
            return error.what();
        }
        return {};
    }
};

TEST(ReportFiles, TheDirectoryIsMadeAndHoldsExactlyTheFilesNamed) {
    const std::filesystem::path target = directory / "deep" / "er";
    const std::vector<std::filesystem::path> written = write_report(target, info, runs);
    LONGS_EQUAL(4, written.size());
    for (const char* name : {"summary.json", "trace.csv", "trace_constant.csv", "report.html"}) {
        CHECK_TEXT(std::filesystem::is_regular_file(target / name), name);
    }
    const auto entries = std::filesystem::directory_iterator(target);
    LONGS_EQUAL(4, std::distance(begin(entries), end(entries)));  // no temporary file is left
    CHECK(millforce::host::JsonCheck::valid(content_of(target / "summary.json")));
    CHECK(content_of(target / "trace.csv") == trace_csv(runs[0]));
    CHECK(content_of(target / "trace_constant.csv") == trace_csv(runs[1]));
}

TEST(ReportFiles, AnEarlierReportIsReplaced) {
    std::filesystem::create_directories(directory);
    std::ofstream(directory / "report.html") << "old";
    write_report(directory, info, runs);
    CHECK(content_of(directory / "report.html").starts_with("<!DOCTYPE html>"));
}

TEST(ReportFiles, AFileInTheWayIsOneLineOfError) {
    std::filesystem::create_directories(directory);
    std::ofstream(directory / "taken") << "x";
    for (const std::filesystem::path& target : {directory / "taken", directory / "taken" / "below"}) {
        const std::string error = error_of_writing_to(target);
        CHECK_TEXT(error.find(target.string()) != std::string::npos, error.c_str());
        CHECK(error.find('\n') == std::string::npos);
    }
    STRCMP_EQUAL("x", content_of(directory / "taken").c_str());
}

TEST(ReportFiles, ADirectoryThatCannotBeWrittenToIsOneLineOfError) {
    const std::string error = error_of_writing_to("/proc/millforce_report");
    CHECK_TEXT(error.find("/proc/millforce_report") != std::string::npos, error.c_str());
    CHECK(error.find('\n') == std::string::npos);
}

TEST(ReportFiles, AFileThatCannotBeWrittenLeavesTheEarlierOne) {
    // A directory of the file's name cannot be replaced by a file.
    std::filesystem::create_directories(directory / "report.html" / "kept");
    const std::string error = error_of_writing_to(directory);
    CHECK_TEXT(error.find("report.html") != std::string::npos, error.c_str());
    CHECK(std::filesystem::is_directory(directory / "report.html" / "kept"));
}
