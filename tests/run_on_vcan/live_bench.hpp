// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "program/inputs.hpp"
#include "program/program.hpp"
#include "vcan/bus_peers.hpp"

/// `millforce run` and `millforce simulate --bus` as two processes on vcan0.

namespace millforce::vcan {

/// The machine of the scenarios with a bus slow enough for a virtual kernel on a busy host: SYNC every 4 ms, patient
/// time-outs.
inline std::string slow_machine() {
    std::string text = test::text_of(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml");
    text = test::with(text, "sync_period_ms = 1.0", "sync_period_ms = 4.0\nprogram_status_timeout_ms = 2000");
    text = test::with(text, "collect_time_ms = 0.9", "collect_time_ms = 4.0");
    return test::with(text, "[cnc]", "[cnc]\nsample_rate_hz = 250\nstale_s = 0.4");
}

/// At 2000 rpm: two samples in a tooth's time.
inline const std::string slow_scenario = test::straight_cut(2000, 800, 2, 22);

/// A part program through a block, without its table [stock].
inline const std::string part_scenario = R"(machine = "machine.toml"
tool = "tool.toml"
program = "part.ngc"
seed = 5
[material]
K_tc_N_mm2 = 1650
K_rc_N_mm2 = 620
K_te_N_mm = 22
K_re_N_mm = 28
)";

using Words = std::vector<std::string>;

inline Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

inline bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

class LiveFolder {
  public:
    LiveFolder() : path_(temporary_file("live")) {
        std::filesystem::create_directories(path_);
        write("machine.toml", slow_machine());
        write("tool.toml", test::text_of(MILLFORCE_SOURCE_DIR "/sim/scenarios/tools/endmill_10mm.toml"));
        write("scenario.toml", slow_scenario);
    }
    ~LiveFolder() { std::filesystem::remove_all(path_); }
    LiveFolder(const LiveFolder&) = delete;
    LiveFolder& operator=(const LiveFolder&) = delete;

    [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }
    [[nodiscard]] std::string text(const std::string& name) const { return test::text_of(file(name)); }
    void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }

    [[nodiscard]] Words run_words() const {
        return {"run",   "vcan0",           "--machine", file("machine.toml"), "--tool", file("tool.toml"),
                "--log", file("run.jsonl"), "--record",  file("run.log")};
    }
    [[nodiscard]] Words plant_words() const {
        return {"simulate", file("scenario.toml"), "--bus", "vcan0", "--out", file("out")};
    }
    /// Waits for a text in the run's log of conditions. In vain: prints what was logged last beside estimates.
    [[nodiscard]] bool logged(const std::string& part) const {
        const bool is_logged = wait_until([&] { return text("run.jsonl").find(part) != std::string::npos; });
        if (!is_logged) {
            std::printf("%s was not logged, but:\n%s", part.c_str(), last_conditions().c_str());
        }
        return is_logged;
    }

  private:
    [[nodiscard]] std::string last_conditions() const {
        constexpr std::size_t enough = 12;
        std::deque<std::string> last;
        std::istringstream lines(text("run.jsonl"));
        for (std::string line; std::getline(lines, line);) {
            const bool is_fault = line.find("\"fault\":\"none\"") == std::string::npos;
            if (line.find("\"type\":\"estimate\"") == std::string::npos || is_fault) {
                last.push_back(line + "\n");
            }
            if (last.size() > enough) {
                last.pop_front();
            }
        }
        return std::accumulate(last.begin(), last.end(), std::string());
    }

    std::string path_;
};

/// The controller and the plant of a folder in lock-step, so that a run does not depend on how busy this computer is.
class LockStep {
  public:
    LockStep(const Words& run, const LiveFolder& folder)
        : controller_(with(run, {"--lock-step"})), plant_(with(folder.plant_words(), {"--lock-step"})) {}

    /// To the end of the program.
    void mill() {
        plant_.wait();
        end(controller_);
    }
    /// Where it is.
    void stop() {
        end(controller_);
        end(plant_);
    }
    /// Once they have ended.
    [[nodiscard]] const test::Program& controller() const { return controller_; }
    [[nodiscard]] const test::Program& plant() const { return plant_; }

  private:
    static void end(test::Program& program) {
        program.interrupt(SIGTERM);
        program.wait();
    }

    test::Program controller_;
    test::Program plant_;
};

/// The value of a member in a line of JSON as it stands there; "" for null.
inline std::string member(const std::string& line, const std::string& key) {
    const std::size_t at = line.find("\"" + key + "\":");
    if (at == std::string::npos) {
        return "missing";
    }
    const std::size_t begin = at + key.size() + 3;
    const std::string value = line.substr(begin, line.find_first_of(",}", begin) - begin);
    return value == "null" ? "" : value;
}

/// The estimates of a log of `run` as rows of a replay.
inline std::vector<std::string> estimates_of(const std::string& jsonl) {
    std::vector<std::string> rows;
    std::istringstream lines(jsonl);
    for (std::string line; std::getline(lines, line);) {
        if (line.find("\"type\":\"estimate\"") == std::string::npos) {
            continue;
        }
        std::string row;
        for (const char* key : {"state", "tangential_force_N", "feed_force_N", "radial_immersion",
                                "radial_immersion_sd", "axial_depth_mm", "axial_depth_sd_mm", "peak_force_N",
                                "force_limit_N", "override", "runout_um", "cut_side", "law_misfit", "limit", "fault"}) {
            std::string value = member(line, key);
            std::erase(value, '"');
            row += (row.empty() ? "" : ",") + value;
        }
        rows.push_back(row);
    }
    return rows;
}

/// The rows of a replay without their times.
inline std::vector<std::string> rows_of(const std::string& csv) {
    std::vector<std::string> rows;
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        rows.push_back(line.substr(line.find(',') + 1));
    }
    return rows;
}

}  // namespace millforce::vcan
