// SPDX-License-Identifier: Apache-2.0
#include "commission/commissioning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <string_view>

#include "calibration/calibration_report.hpp"
#include "commission/drive_answers.hpp"
#include "commission/first_files.hpp"
#include "files/input_error.hpp"
#include "parameters/parameter_files.hpp"

namespace millforce::host {

namespace {
constexpr std::array<std::string_view, 6> plan_keys{
    "idle.", "air.", "standard_cut.", "machine.axes", "tool.diameter_mm", "tool.teeth"};
}

std::size_t axis_number(const std::string& axis) {
    return axis == "x" ? 0 : axis == "y" ? 1 : 2;
}

std::vector<std::string> cutting_axes(const std::vector<std::string>& axes) {
    std::vector<std::string> result = axes;
    std::erase(result, "z");
    return result;
}

int Commissioning::run() {
    prepare();
    if (!idle() || !air() || !cuts("standard", plan_.standard) || !fit() || !cuts("validation", plan_.validation) ||
        !validate()) {
        write_page();
        return exit_bound_broken;
    }
    write_files();
    write_page();
    const bool is_good =
        std::all_of(verdicts_.begin(), verdicts_.end(), [](const StepVerdict& v) { return v.is_good; });
    out_ << (is_good ? "good enough: all of it\n" : "written, but see what is to be repeated\n");
    return is_good ? exit_done : exit_bound_broken;
}

void Commissioning::prepare() {
    for (const std::string& step : options_.repeated) {
        session_.set_aside(step);
    }
    if (session_.has("answers.toml")) {
        answers_.add_known(session_.file("answers.toml").string());
    }
    axes_ = axes_of(answers_);
    if (live_ != nullptr) {
        find_drives();
    }
    machine_ = first_machine_file(answers_, live_ != nullptr ? Connection::can : Connection::hal);
    plan_ = plan_of(answers_, axes_);
    if (!plan_.entry.empty()) {
        entry_ = library_entry(plan_.database, plan_.entry);
    }
    std::ostringstream advice;
    tool_ = first_tool_file(answers_, answers_.asks() ? out_ : advice, KnownLaw{entry_.law, entry_.source});
    answers_.require_all();
    refuse_changed_plan();
    out_ << (session_.has("answers.toml") ? "" : advice.str());
    session_.write("answers.toml", answers_.text());
    save_first_files();
    write_programs();
}

/// What the drives say answers the questions for them.
void Commissioning::find_drives() {
    if (!session_.has("drives.toml")) {
        const std::vector<FoundDrive> drives = live_->find_drives();
        for (const FoundDrive& drive : drives) {
            out_ << drive.words() << '\n';
        }
        const std::string said = answers_of_drives(drives, axes_, answers_);
        answers_.require_all(false);  // what they say depends on the screw's lead
        session_.write("drives.toml", said);
    }
    answers_.add_known(session_.file("drives.toml").string());
}

/// What the steps run with: a controller that watches, sends 1 for its override, and faults at nothing that is not
/// measured yet. No axis has a force, and no torque is a contact.
void Commissioning::save_first_files() {
    FileDraft machine = machine_;
    machine.set("spindle", "idle_torque_sd_Nm", 1e3);
    for (const std::string& axis : axes_) {
        machine.set(axis, "K_x4_N_per_A", 0.0);
    }
    machine.save(session_.file("watching_machine.toml"));
    FileDraft tool = tool_;
    tool.set_flag("control", "monitor_only", true);
    tool.set("tool", "tooth_force_limit_N", 1e6);
    tool.set("control", "contact_force_N", 1e4);
    tool.save(session_.file("watching_tool.toml"));
    first_ =
        read_parameters(session_.file("watching_machine.toml").string(), session_.file("watching_tool.toml").string());
}

/// The recordings of the session are of the programs that its answers gave.
void Commissioning::refuse_changed_plan() const {
    std::ifstream file(session_.file("answers.toml"));
    const std::string answers = answers_.text();
    for (std::string line; std::getline(file, line);) {
        const std::string key = line.substr(0, line.find(" = "));
        const bool is_of_plan = std::any_of(plan_keys.begin(), plan_keys.end(),
                                            [&](std::string_view start) { return key.starts_with(start); });
        if (is_of_plan && has_recordings() && answers.find(line + "\n") == std::string::npos) {
            throw InputError(
                fmt::format("{}: {}: another answer than when the recordings were made; expected the same, "
                            "or another session",
                            session_.file("answers.toml").string(), line));
        }
    }
}

bool Commissioning::has_recordings() const {
    const auto entries = std::filesystem::directory_iterator(session_.folder());
    return std::any_of(begin(entries), end(entries),
                       [](const auto& entry) { return entry.path().string().ends_with(".1.csv"); });
}

void Commissioning::write_programs() {
    session_.write("idle.ngc", idle_program(plan_));
    session_.write("air.ngc", air_program(plan_));
    for (const std::string& axis : cutting_axes(axes_)) {
        session_.write("standard_" + axis + ".ngc", cut_program(plan_, axis, plan_.standard));
        session_.write("validation_" + axis + ".ngc", cut_program(plan_, axis, plan_.validation));
    }
}

/// Feeds the watch with what the session has, then with the machine or with the recordings that were given.
bool Commissioning::watch(const std::string& step, StepWatch& watch, bool in_pieces, const std::string& hint) {
    feed_recordings(session_.recordings(step), counts_per_rev(), watch);
    watch.take_news();
    if (watch.is_enough()) {
        return true;
    }
    out_ << fmt::format("{}: missing: {}\n{}: run {} on the machine. {}\n", step, watch.lacks(), step,
                        session_.file(step + ".ngc").string(), hint)
         << std::flush;
    if (live_ != nullptr) {
        return record_live(step, watch, in_pieces);
    }
    return take_given(step, watch);
}

bool Commissioning::record_live(const std::string& step, StepWatch& watch, bool in_pieces) {
    StepRecorder recorder(session_, step, counts_per_rev(), watch, in_pieces);
    const bool goes_on =
        live_->record(session_.file("watching_machine.toml"), session_.file("watching_tool.toml"), recorder, watch);
    recorder.finish();
    show_news(watch);
    if (!goes_on || !watch.is_enough()) {
        verdicts_.push_back({step, false, "interrupted; start again to go on. Missing: " + watch.lacks(), ""});
        show_verdict();
        return false;
    }
    return true;
}

bool Commissioning::take_given(const std::string& step, StepWatch& watch) {
    const auto given = options_.recordings.find(step);
    if (given == options_.recordings.end()) {
        verdicts_.push_back(
            {step, false,
             fmt::format("not recorded yet: record {}.ngc and give it with --recording {}=FILE.csv", step, step), ""});
        show_verdict();
        return false;
    }
    const std::size_t before = session_.recordings(step).size();
    for (const auto& file : given->second) {
        const RecordingReader refuses_what_is_none(file, counts_per_rev());  // before it is copied
        const auto target = session_.next_recording(step);
        std::filesystem::copy_file(file, target.string() + ".part", std::filesystem::copy_options::overwrite_existing);
        std::filesystem::rename(target.string() + ".part", target);
    }
    const auto all = session_.recordings(step);
    feed_recordings({all.begin() + static_cast<std::ptrdiff_t>(before), all.end()}, counts_per_rev(), watch);
    show_news(watch);
    if (!watch.is_enough()) {
        verdicts_.push_back({step, false, "the recording is not enough. Missing: " + watch.lacks(), ""});
        show_verdict();
    }
    return watch.is_enough();
}

void Commissioning::show_news(StepWatch& watch) {
    for (const std::string& line : watch.take_news()) {
        out_ << line << '\n';
    }
}

void Commissioning::show_verdict() {
    const StepVerdict& verdict = verdicts_.back();
    out_ << fmt::format("{}: {}\n", verdict.step, verdict.words) << std::flush;
}

void Commissioning::judge(const std::string& step, bool is_good, const std::string& words, const std::string& details) {
    verdicts_.push_back({step, is_good, (is_good ? "good enough: " : "to be repeated: ") + words, details});
    show_verdict();
}

/// A fit that refuses its data says why; the recordings are set aside, so that the next start repeats the step.
void Commissioning::refuse(const std::vector<std::string>& steps, const InputError& error) {
    for (const std::string& step : steps) {
        session_.set_aside(step);
    }
    verdicts_.push_back(
        {steps.front(), false,
         fmt::format("to be repeated: {}. The recordings are kept as *.refused; start again", error.what()), ""});
    show_verdict();
}

const std::vector<std::string>& commission_steps() {
    static const std::vector<std::string> steps{"idle",       "air",          "standard_x",
                                                "standard_y", "validation_x", "validation_y"};
    return steps;
}

int commission(const CommissionOptions& options, Answers& answers, LiveMachine* live, std::ostream& out) {
    return Commissioning(options, answers, live, out).run();
}

}  // namespace millforce::host
