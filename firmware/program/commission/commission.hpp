// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "commission/answers.hpp"
#include "commission/drive_search.hpp"
#include "commission/plan.hpp"
#include "commission/session.hpp"
#include "commission/step_recorder.hpp"

namespace millforce::host {

/// A machine that runs now. The commissioning knows it by this alone.
class LiveMachine {
  public:
    LiveMachine() = default;
    virtual ~LiveMachine() = default;
    LiveMachine(const LiveMachine&) = delete;
    LiveMachine& operator=(const LiveMachine&) = delete;

    virtual std::vector<FoundDrive> find_drives() = 0;
    /// Hands samples to the recorder until it says that the step is over, or until there is enough and no sample comes
    /// any more. Lines of the watch are printed as they come. False: the operator has interrupted.
    virtual bool record(const std::filesystem::path& machine, const std::filesystem::path& tool, StepRecorder& recorder,
                        StepWatch& watch) = 0;
};

struct CommissionOptions {
    std::filesystem::path session;
    /// Recordings of a machine that is not on a bus, by step: "idle", "air", "standard_x", "validation_x" …
    std::map<std::string, std::vector<std::filesystem::path>> recordings;
    std::vector<std::string> repeated;  ///< steps whose recordings are set aside, to be done again
};

/// How a step ended.
struct StepVerdict {
    std::string step;
    bool is_good = false;
    std::string words;    ///< good enough, or what to repeat and why
    std::string details;  ///< the fit's own report
};

/// The names of the steps on the machine.
const std::vector<std::string>& commission_steps();

/// One commissioning from wherever the session is: find the drives, idle, air cuts, standard cuts, fit, validation,
/// machine.toml, tool.toml and report.html. `live` may be null: then the steps take the recordings. Returns the
/// program's exit code: 0 done, and all is good enough; 1 something is to be repeated, or a recording is still missing.
/// Throws InputError for answers and files that are wrong.
int commission(const CommissionOptions& options, Answers& answers, LiveMachine* live, std::ostream& out);

}  // namespace millforce::host
