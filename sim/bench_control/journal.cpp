// SPDX-License-Identifier: Apache-2.0
#include "bench_control/journal.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"

namespace millforce::sim {

namespace {

constexpr std::string_view journal_format = "millforce bench control 1";
constexpr std::string_view column_line =
    "part,controller,seed,time_s,cutting_time_s,peak_over_limit,revolutions_over,teeth_broken,rubbing_s,finished";

std::string journal_head(std::uint32_t settings) {
    return fmt::format("# {}\n# settings {:08x}\n{}\n", journal_format, settings, column_line);
}

std::string journal_line(const BenchRun& run) {
    const auto cell = [](double value) { return host::CsvWriter::cell(value); };
    return fmt::format("{},{},{},{},{},{},{},{},{},{}\n", run.part, run.controller, run.seed, cell(run.time_s),
                       cell(run.cutting_time_s), cell(run.peak_over_limit), cell(run.revolutions_over),
                       cell(run.teeth_broken), cell(run.rubbing_s), cell(run.finished));
}

auto key_of(const BenchRun& run) {
    return std::tuple(run.part, run.controller, run.seed);
}

void cut_off_unfinished_line(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::size_t end = text.rfind('\n');
    const std::size_t whole = end == std::string::npos ? 0 : end + 1;
    if (whole < text.size()) {
        std::filesystem::resize_file(file, whole);
    }
}

void require_settings(const host::CsvReader& csv, const std::filesystem::path& file, std::uint32_t settings) {
    const auto& comments = csv.comments();
    if (std::ranges::find(comments, journal_format) == comments.end()) {
        throw host::InputError(fmt::format("{}: no line '# {}'; expected a journal of 'millforce bench control'",
                                           file.string(), journal_format));
    }
    if (std::ranges::find(comments, fmt::format("settings {:08x}", settings)) == comments.end()) {
        throw host::InputError(
            fmt::format("{}: its runs are of another program or other settings; delete it, or choose another --out",
                        file.string()));
    }
}

}  // namespace

std::vector<BenchRun> read_runs(const std::filesystem::path& file, std::uint32_t settings) {
    host::CsvReader csv(file);
    require_settings(csv, file, settings);
    const auto column = [&](const char* name) { return csv.require(name); };
    const auto part = column("part");
    const auto controller = column("controller");
    const auto seed = column("seed");
    const std::pair<host::CsvColumn, double BenchRun::*> numbers[] = {
        {column("time_s"), &BenchRun::time_s},
        {column("cutting_time_s"), &BenchRun::cutting_time_s},
        {column("peak_over_limit"), &BenchRun::peak_over_limit},
        {column("revolutions_over"), &BenchRun::revolutions_over},
        {column("teeth_broken"), &BenchRun::teeth_broken},
        {column("rubbing_s"), &BenchRun::rubbing_s},
        {column("finished"), &BenchRun::finished},
    };
    std::vector<BenchRun> runs;
    while (csv.next_row()) {
        BenchRun run;
        run.part = csv.text(part);
        run.controller = csv.text(controller);
        run.seed = static_cast<std::uint64_t>(csv.required_number(seed, 0.0, 4294967295.0));
        for (const auto& [place, member] : numbers) {
            run.*member = csv.required_number(place, 0.0, 1e9);
        }
        runs.push_back(std::move(run));
    }
    return runs;
}

Journal::Journal(const std::filesystem::path& file, std::uint32_t settings) : file_(file), settings_(settings) {
    if (std::filesystem::exists(file)) {
        cut_off_unfinished_line(file);
    }
    const bool is_new = !std::filesystem::exists(file) || std::filesystem::file_size(file) == 0;
    if (!is_new) {
        runs_ = read_runs(file, settings);
        for (const BenchRun& run : runs_) {
            known_.insert(key_of(run));
        }
    }
    out_.open(file, std::ios::binary | std::ios::app);
    if (is_new) {
        out_ << journal_head(settings) << std::flush;
    }
    if (!out_) {
        throw host::InputError(file.string() + ": cannot be written");
    }
}

bool Journal::has(std::string_view part, std::string_view controller, std::uint64_t seed) const {
    return known_.contains(Key(part, controller, seed));
}

void Journal::add(const BenchRun& run) {
    const std::lock_guard lock(mutex_);
    out_ << journal_line(run) << std::flush;
    if (!out_) {
        throw host::InputError(file_.string() + ": cannot be written");
    }
    known_.insert(key_of(run));
    runs_.push_back(run);
}

std::vector<BenchRun> Journal::runs() const {
    std::vector<BenchRun> sorted = runs_;
    std::ranges::sort(sorted, {}, key_of);
    return sorted;
}

void Journal::sort_file() const {
    host::AtomicFile file(file_);
    file.stream() << journal_head(settings_);
    for (const BenchRun& run : runs()) {
        file.stream() << journal_line(run);
    }
    file.commit();
}

}  // namespace millforce::sim
