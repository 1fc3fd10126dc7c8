// SPDX-License-Identifier: Apache-2.0
#include "commission/commission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>

#include "calibration/calibration_report.hpp"
#include "calibration/friction_calibration.hpp"
#include "calibration/standard_cut_calibration.hpp"
#include "check/check_parameters.hpp"
#include "check/check_recording.hpp"
#include "commission/air_watch.hpp"
#include "commission/commission_page.hpp"
#include "commission/first_files.hpp"
#include "commission/idle_watch.hpp"
#include "commission/validation.hpp"
#include "files/input_error.hpp"
#include "files/toml_writer.hpp"
#include "parameters/parameter_files.hpp"

namespace millforce::host {

namespace {

constexpr double mm_min_per_m_per_min = 1000.0;

std::size_t axis_number(const std::string& axis) {
    return axis == "x" ? 0 : axis == "y" ? 1 : 2;
}

/// Where the tool can cut along: down milling on the side of a block.
std::vector<std::string> cutting_axes(const std::vector<std::string>& axes) {
    std::vector<std::string> result = axes;
    std::erase(result, "z");
    return result;
}

class Commissioning {
  public:
    Commissioning(const CommissionOptions& options, Answers& answers, LiveMachine* live, std::ostream& out)
        : options_(options), session_(options.session), answers_(answers), live_(live), out_(out) {}

    int run() {
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

  private:
    void prepare() {
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
        tool_ = first_tool_file(answers_, advice, KnownLaw{entry_.law, entry_.source});
        answers_.require_all();
        out_ << advice.str();
        session_.write("answers.toml", answers_.text());
        save_first_files();
        write_programs();
    }

    /// What the drives say answers the questions for them.
    void find_drives() {
        if (!session_.has("drives.toml")) {
            const std::vector<FoundDrive> drives = live_->find_drives();
            for (const FoundDrive& drive : drives) {
                out_ << drive.words() << '\n';
            }
            session_.write("drives.toml", answers_of(drives));
        }
        answers_.add_known(session_.file("drives.toml").string());
    }

    std::string answers_of(const std::vector<FoundDrive>& drives) {
        if (drives.empty()) {
            throw InputError("no node answers on this bus; expected drives with CANopen, powered, at this bit rate");
        }
        std::string text;
        std::vector<std::string> roles{"spindle"};
        roles.insert(roles.end(), axes_.begin(), axes_.end());
        for (std::size_t place = 0; place < roles.size(); ++place) {
            const std::string& role = roles[place];
            const auto usual = place < drives.size() ? std::optional<double>(drives[place].node_id) : std::nullopt;
            const auto node = answers_.integer(
                {"bus." + role + ".node_id", fmt::format("Node of the {} drive", role), "", 1.0, 127.0, usual});
            const auto found = std::find_if(drives.begin(), drives.end(),
                                            [&](const FoundDrive& drive) { return drive.node_id == node; });
            if (found == drives.end() || !found->is_cia402()) {
                throw InputError(fmt::format("bus.{}.node_id = {}: no CiA 402 drive answers there", role, node));
            }
            text += fmt::format("bus.{}.node_id = {}\n", role, node) + answers_of(*found, role);
        }
        return text;
    }

    std::string answers_of(const FoundDrive& drive, const std::string& role) {
        std::string text;
        const auto add = [&](const std::string& key, double value) {
            text += fmt::format("{}.{} = {}\n", role, key, toml_number(value));
        };
        if (drive.rated_current_mA) {
            add("rated_current_A", 1e-3 * *drive.rated_current_mA);
        }
        if (drive.rated_current_mA && drive.rated_torque_mNm && role == "spindle") {
            add("rated_torque_Nm", 1e-3 * *drive.rated_torque_mNm);
            add("rated_torque_current_A", 1e-3 * *drive.rated_current_mA);
        } else if (drive.rated_current_mA && drive.rated_torque_mNm) {
            add("torque_constant_Nm_per_A", static_cast<double>(*drive.rated_torque_mNm) / *drive.rated_current_mA);
        }
        if (role == "spindle" && drive.encoder_counts) {
            text += fmt::format("spindle.encoder_counts_per_rev = {}\n", *drive.encoder_counts);
        }
        if (role == "spindle" && drive.has_index_latch) {
            text += "bus.spindle.index_latch = true\n";
        }
        if (role == "spindle" || !drive.velocity_unit) {
            return text;
        }
        const double travel_mm =
            answers_.number({role + ".travel_per_motor_turn_mm", role + ": travel per turn of the motor (screw lead)",
                             "mm", 0.01, 1e3});
        if (const auto unit = drive.velocity_mm_s(travel_mm)) {
            text += fmt::format("bus.{}.velocity_mm_s_per_unit = {}\n", role, toml_number(*unit));
        }
        return text;
    }

    /// What the steps run with: a controller that watches, sends 1 for its override, and faults at nothing that is not
    /// measured yet. No axis has a force, and no torque is a contact.
    void save_first_files() {
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
        first_ = read_parameters(session_.file("watching_machine.toml").string(),
                                 session_.file("watching_tool.toml").string());
    }

    void write_programs() {
        session_.write("idle.ngc", idle_program(plan_));
        session_.write("air.ngc", air_program(plan_));
        for (const std::string& axis : cutting_axes(axes_)) {
            session_.write("standard_" + axis + ".ngc", cut_program(plan_, axis, plan_.standard));
            session_.write("validation_" + axis + ".ngc", cut_program(plan_, axis, plan_.validation));
        }
    }

    /// Feeds the watch with what the session has, then with the machine or with the recordings that were given.
    bool watch(const std::string& step, StepWatch& watch, bool in_pieces, const std::string& hint) {
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

    bool record_live(const std::string& step, StepWatch& watch, bool in_pieces) {
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

    bool take_given(const std::string& step, StepWatch& watch) {
        const auto given = options_.recordings.find(step);
        if (given == options_.recordings.end()) {
            verdicts_.push_back(
                {step, false,
                 fmt::format("not recorded yet: record {}.ngc and give it with --recording {}=FILE.csv", step, step),
                 ""});
            show_verdict();
            return false;
        }
        const std::size_t before = session_.recordings(step).size();
        for (const auto& file : given->second) {
            RecordingReader(file, counts_per_rev());  // refuses what is no recording before it is copied
            const auto target = session_.next_recording(step);
            std::filesystem::copy_file(file, target.string() + ".part",
                                       std::filesystem::copy_options::overwrite_existing);
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

    void show_news(StepWatch& watch) {
        for (const std::string& line : watch.take_news()) {
            out_ << line << '\n';
        }
    }

    void show_verdict() {
        const StepVerdict& verdict = verdicts_.back();
        out_ << fmt::format("{}: {}\n", verdict.step, verdict.words) << std::flush;
    }

    void judge(const std::string& step, bool is_good, const std::string& words, const std::string& details = {}) {
        verdicts_.push_back({step, is_good, (is_good ? "good enough: " : "to be repeated: ") + words, details});
        show_verdict();
    }

    /// A fit that refuses its data says why; the recordings are set aside, so that the next start repeats the step.
    void refuse(const std::vector<std::string>& steps, const InputError& error) {
        for (const std::string& step : steps) {
            session_.set_aside(step);
        }
        verdicts_.push_back(
            {steps.front(), false,
             fmt::format("to be repeated: {}. The recordings are kept as *.refused; start again", error.what()), ""});
        show_verdict();
    }

    bool idle() {
        idle_watch_ = std::make_unique<IdleWatch>(counts_per_rev(), plan_.idle_rpm.size(), plan_.idle_dwell_s);
        if (!watch("idle", *idle_watch_, true,
                   "The tool is in air, the axes rest; best after ten minutes of running.")) {
            return false;
        }
        const auto fit = idle_watch_->fit();
        if (!fit) {
            throw std::logic_error("idle: enough, and no fit");
        }
        idle_ = *fit;
        constexpr double largest_share = 0.05;
        const double middle_A = std::abs(idle_watch_->plateaus().front().current_A);
        judge(
            "idle", idle_.residual_A <= largest_share * middle_A,
            fmt::format("the idle current is {:.4f} ± {:.4f} A + ({:.3g} ± {:.2g}) A·s/rad × speed to within {:.4f} A "
                        "({:.1f} %, bound {:.0f} %){}",
                        idle_.offset_A, idle_.offset_se, idle_.slope_A_s, idle_.slope_se, idle_.residual_A,
                        100.0 * idle_.residual_A / middle_A, 100.0 * largest_share,
                        idle_.residual_A <= largest_share * middle_A
                            ? ""
                            : "; run the spindle warm for ten minutes, then delete idle.*.csv and start again"));
        return true;
    }

    bool air() {
        std::vector<std::size_t> axes;
        for (const std::string& axis : axes_) {
            axes.push_back(axis_number(axis));
        }
        std::vector<double> feeds;
        for (const double feed : plan_.air_feeds_mm_min) {
            feeds.push_back(feed / mm_min_per_m_per_min);
        }
        air_watch_ = std::make_unique<AirWatch>(axes, feeds);
        if (!watch("air", *air_watch_, true, "The tool is in air; each axis travels in + from where it stands.")) {
            return false;
        }
        std::ostringstream report;
        try {
            FrictionCalibrationOptions friction;
            friction.data = session_.recordings("air");
            friction.output = session_.file("friction.toml");
            const bool kept = calibrate_friction(friction, report) == exit_done;
            machine_.merge(session_.file("friction.toml"), "air cuts");
            judge("air", kept,
                  kept ? "friction of each axis is a function of the feed and did not change"
                       : "the friction changed while it was measured; move the axes for ten minutes, delete air.*.csv "
                         "and start again",
                  report.str());
            return true;
        } catch (const InputError& error) {
            refuse({"air"}, error);
            return false;
        }
    }

    CutWatchSettings watch_settings(const std::string& axis, const std::vector<CutPass>& passes) const {
        CutWatchSettings settings;
        settings.counts_per_rev = counts_per_rev();
        settings.axis = axis_number(axis);
        settings.passes = passes;
        settings.tool_diameter_mm = plan_.tool_diameter_mm;
        settings.flutes = plan_.flutes;
        settings.travel_per_motor_turn_mm = plan_.travel_per_motor_turn_mm;
        settings.smallest_rise_A = smallest_rise_A(passes);
        return settings;
    }

    /// By the published law and the data sheet's torque per ampere.
    double smallest_rise_A(const std::vector<CutPass>& passes) const {
        double smallest_A = HUGE_VAL;
        for (const CutPass& pass : passes) {
            const double feed_per_tooth_mm = pass.feed_mm_min / plan_.cut_rpm / plan_.flutes;
            const double radius_mm = 0.5 * plan_.tool_diameter_mm;
            const auto forces = estimation::average_forces<double>(
                entry_.law, {feed_per_tooth_mm, pass.axial_depth_mm,
                             estimation::engagement_angles(estimation::CutSide::down, pass.radial_width_mm / radius_mm),
                             static_cast<double>(plan_.flutes)});
            const double torque_Nm = forces.tangential_N * 1e-3 * radius_mm;
            smallest_A = std::min(smallest_A, torque_Nm / static_cast<double>(first_.machine.spindle.K_t1_Nm_per_A));
        }
        return smallest_A;
    }

    /// A recording of cuts counts as a whole: the passes come in their order.
    bool cuts(const std::string& kind, const std::vector<CutPass>& passes) {
        for (const std::string& axis : cutting_axes(axes_)) {
            const std::string step = kind + "_" + axis;
            if (!session_.has(step + "_cuts.csv") && !record_cuts(step, watch_settings(axis, passes))) {
                return false;
            }
        }
        return true;
    }

    bool record_cuts(const std::string& step, const CutWatchSettings& settings) {
        for (const auto& recording : session_.recordings(step)) {
            std::filesystem::rename(recording, recording.string() + ".incomplete");
        }
        CutWatch cut_watch(settings);
        const std::string hint = fmt::format("Origin: top corner of the block, {:.1f} mm long or more; down milling.",
                                             block_length_mm(plan_));
        if (!watch(step, cut_watch, false, hint)) {
            return false;
        }
        cut_watch.write_table(session_.file(step + "_cuts.csv"), session_.recordings(step).back());
        return true;
    }

    std::vector<std::filesystem::path> recordings_of(const std::string& kind) const {
        std::vector<std::filesystem::path> files;
        for (const std::string& axis : cutting_axes(axes_)) {
            const auto found = session_.recordings(kind + "_" + axis);
            files.insert(files.end(), found.begin(), found.end());
        }
        return files;
    }

    std::filesystem::path joined_table(const std::string& kind) const;

    std::vector<std::string> steps_of(const std::string& kind) const {
        std::vector<std::string> steps;
        for (const std::string& axis : cutting_axes(axes_)) {
            steps.push_back(kind + "_" + axis);
        }
        return steps;
    }

    bool fit() {
        add_idle(machine_, static_cast<double>(first_.machine.spindle.K_t1_Nm_per_A));
        machine_.save(session_.file("before_cuts.toml"));
        std::ostringstream report;
        try {
            StandardCutOptions standard;
            standard.data = recordings_of("standard");
            standard.cuts = joined_table("standard");
            standard.machine = session_.file("before_cuts.toml");
            standard.database = plan_.database;
            standard.entry = plan_.entry;
            standard.output = session_.file("gains.toml");
            calibrate_standard_cut(standard, report);
        } catch (const InputError& error) {
            for (const std::string& step : steps_of("standard")) {
                std::filesystem::remove(session_.file(step + "_cuts.csv"));
            }
            refuse(steps_of("standard"), error);
            return false;
        }
        machine_.merge(session_.file("gains.toml"), "standard cut");
        machine_.save(session_.file("fitted.toml"));
        fitted_ = read_machine_parameters(session_.file("fitted.toml").string());
        // The slope is a torque: with the measured gain.
        const auto K_t1 = static_cast<double>(fitted_.spindle.K_t1_Nm_per_A);
        add_idle_slope(machine_, K_t1);
        const double moved_Nm = std::abs(static_cast<double>(fitted_.spindle.K_t2_Nm) + K_t1 * idle_.offset_A);
        machine_.set("spindle", "idle_torque_sd_Nm",
                     std::max(moved_Nm, static_cast<double>(MachineParameters{}.spindle.idle_torque_sd_Nm)),
                     "how far it moved from the idling to the cuts, or the usual value");
        judge("fit", true, "the drives' gains follow from the standard cuts", report.str());
        return true;
    }

    void add_idle_slope(FileDraft& draft, double K_t1) const {
        draft.set("spindle", "idle_torque_slope_Nm_s", K_t1 * idle_.slope_A_s, "idling at several speeds");
        draft.set("spindle", "idle_torque_slope_Nm_s_se", K_t1 * idle_.slope_se);
    }

    void add_idle(FileDraft& draft, double K_t1) const {
        draft.set("spindle", "K_t2_Nm", -K_t1 * idle_.offset_A, "idling at several speeds");
        draft.set("spindle", "current_sd_A", idle_.noise_A, "measured while idling");
        add_idle_slope(draft, K_t1);
        for (const std::string& axis : axes_) {
            if (const auto noise = air_watch_->current_noise_A(axis_number(axis))) {
                draft.set(axis, "current_sd_A", *noise, "measured in air");
            }
        }
    }

    bool validate() {
        try {
            validated_ = validate_cuts(recordings_of("validation"), joined_table("validation"), fitted_, entry_);
        } catch (const InputError& error) {
            for (const std::string& step : steps_of("validation")) {
                std::filesystem::remove(session_.file(step + "_cuts.csv"));
            }
            refuse(steps_of("validation"), error);
            return false;
        }
        std::string table;
        double largest_torque = 0.0;
        double largest_force = 0.0;
        bool holds = true;
        for (const ValidatedCut& cut : validated_) {
            table += fmt::format(
                "{} {:.0f} mm/min, {:g} mm wide: torque {:.3f} N·m, by the law {:.3f} ({:+.1f} %, bound {:.0f} %); "
                "feed "
                "force {:.1f} N, by the law {:.1f} ({:+.1f} %, bound {:.0f} %)\n",
                cut.axis, cut.feed_mm_min, cut.radial_width_mm, cut.torque_Nm, cut.expected_torque_Nm,
                100.0 * cut.torque_error(), 100.0 * cut.torque_bound, cut.feed_force_N, cut.expected_feed_force_N,
                100.0 * cut.force_error(), 100.0 * cut.force_bound);
            largest_torque = std::max(largest_torque, std::abs(cut.torque_error()));
            largest_force = std::max(largest_force, std::abs(cut.force_error()));
            holds = holds && cut.holds();
        }
        out_ << table;
        judge("validation", holds,
              fmt::format("cuts that the fit has not seen: torque off by {:.1f} % at most, feed force by {:.1f} %{}",
                          100.0 * largest_torque, 100.0 * largest_force,
                          holds ? "" : "; check depth, width and steel of both cuts, and repeat the standard cut"),
              table);
        return true;
    }

    void write_files() {
        machine_.set_heading("description", "Measured by 'millforce commission'");
        machine_.save(session_.file("machine.toml"));
        tool_.save(session_.file("tool.toml"));
        const auto parameters =
            read_parameters(session_.file("machine.toml").string(), session_.file("tool.toml").string());
        Findings findings = check_parameters(parameters);
        append(findings, check_recording(recordings_of("validation").back(), parameters));
        std::string lines;
        for (const Finding& finding : findings) {
            lines += line_of(finding) + "\n";
        }
        out_ << lines;
        judge("check", !is_something_wrong(findings), count_of(findings), lines);
        out_ << session_.file("machine.toml").string() << ": written\n"
             << session_.file("tool.toml").string() << ": written\n";
    }

    void write_page() {
        CommissionPage page;
        page.verdicts = verdicts_;
        if (idle_watch_) {
            page.idle = idle_watch_->plateaus();
            page.idle_fit = idle_watch_->fit();
        }
        for (const std::string& axis : axes_) {
            if (air_watch_) {
                page.air.emplace_back(axis, air_watch_->found(axis_number(axis)));
            }
        }
        page.validated = validated_;
        page.files = {"friction.toml", "gains.toml"};
        session_.write("report.html", page_text(page, session_));
        out_ << "report: " << session_.file("report.html").string() << '\n';
    }

    [[nodiscard]] std::uint32_t counts_per_rev() const { return first_.machine.encoder_counts_per_rev; }

    const CommissionOptions& options_;
    Session session_;
    Answers& answers_;
    LiveMachine* live_;
    std::ostream& out_;
    std::vector<std::string> axes_;
    CommissionPlan plan_{};
    LibraryEntry entry_{};
    FileDraft machine_{firmware::ParameterFile::machine};
    FileDraft tool_{firmware::ParameterFile::tool};
    firmware::Parameters<float> first_{};
    MachineParameters fitted_{};
    std::unique_ptr<IdleWatch> idle_watch_;
    std::unique_ptr<AirWatch> air_watch_;
    IdleFit idle_{};
    std::vector<ValidatedCut> validated_;
    std::vector<StepVerdict> verdicts_;
};

/// The tables of all axes as one, for the calibrations.
std::filesystem::path Commissioning::joined_table(const std::string& kind) const {
    std::string text;
    for (const std::string& step : steps_of(kind)) {
        std::ifstream file(session_.file(step + "_cuts.csv"));
        std::string line;
        std::getline(file, line);
        text = text.empty() ? line + "\n" : text;
        while (std::getline(file, line)) {
            text += line + "\n";
        }
    }
    session_.write(kind + "_cuts.csv", text);
    return session_.file(kind + "_cuts.csv");
}

}  // namespace

int commission(const CommissionOptions& options, Answers& answers, LiveMachine* live, std::ostream& out) {
    return Commissioning(options, answers, live, out).run();
}

}  // namespace millforce::host
