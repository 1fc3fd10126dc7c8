// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "commission/air_watch.hpp"
#include "commission/answers.hpp"
#include "commission/commission.hpp"
#include "commission/file_draft.hpp"
#include "commission/idle_watch.hpp"
#include "commission/plan.hpp"
#include "commission/session.hpp"
#include "commission/validation.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

/// One commissioning: commission() in parts. Where the code is: preparation and recording in commissioning.cpp, the
/// steps on the machine in commission_steps.cpp, what is worked out from them in commission_fits.cpp.
class Commissioning {
  public:
    Commissioning(const CommissionOptions& options, Answers& answers, LiveMachine* live, std::ostream& out)
        : options_(options), session_(options.session), answers_(answers), live_(live), out_(out) {}

    int run();

  private:
    void prepare();
    /// What the drives say answers the questions for them.
    void find_drives();
    /// What the steps run with: a controller that watches, sends 1 for its override, and faults at nothing that is not
    /// measured yet. No axis has a force, and no torque is a contact.
    void save_first_files();
    void refuse_changed_plan() const;
    [[nodiscard]] bool has_recordings() const;
    void write_programs();
    /// Feeds the watch with what the session has, then with the machine or with the recordings that were given.
    bool watch(const std::string& step, StepWatch& watch, bool in_pieces, const std::string& hint);
    bool record_live(const std::string& step, StepWatch& watch, bool in_pieces);
    bool take_given(const std::string& step, StepWatch& watch);
    void show_news(StepWatch& watch);
    void show_verdict();
    void judge(const std::string& step, bool is_good, const std::string& words, const std::string& details = {});
    /// A fit that refuses its data says why; the recordings are set aside, so that the next start repeats the step.
    void refuse(const std::vector<std::string>& steps, const InputError& error);
    bool idle();
    bool air();
    [[nodiscard]] CutWatchSettings watch_settings(const std::string& axis, const std::vector<CutPass>& passes) const;
    /// By the published law and the data sheet's torque per ampere.
    [[nodiscard]] double smallest_rise_A(const std::vector<CutPass>& passes) const;
    /// A recording of cuts counts as a whole: the passes come in their order.
    bool cuts(const std::string& kind, const std::vector<CutPass>& passes);
    bool record_cuts(const std::string& step, const CutWatchSettings& settings);
    [[nodiscard]] std::vector<std::filesystem::path> recordings_of(const std::string& kind) const;
    [[nodiscard]] std::vector<std::string> steps_of(const std::string& kind) const;
    bool fit();
    void add_idle_slope(FileDraft& draft, double K_t1) const;
    void add_idle(FileDraft& draft, double K_t1) const;
    bool validate();
    void write_files();
    void write_page();
    /// The tables of cuts of all axes as one, for the calibrations.
    [[nodiscard]] std::filesystem::path joined_table(const std::string& kind) const;
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

/// 0 x, 1 y, 2 z.
std::size_t axis_number(const std::string& axis);

/// Where the tool can cut along: the side of a block.
std::vector<std::string> cutting_axes(const std::vector<std::string>& axes);

}  // namespace millforce::host
