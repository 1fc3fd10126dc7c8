// SPDX-License-Identifier: Apache-2.0
#include "csv_rows.hpp"
#include "inputs.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <thread>

#include <CppUTest/TestHarness.h>

using namespace millforce::test;

namespace {

/// Rows by their time to the microsecond.
std::map<long, CsvRow> rows_of(const std::string& csv) {
    std::map<long, CsvRow> rows;
    for (const CsvRow& row : csv_rows(csv)) {
        rows[std::lround(std::atof(row.at("time_s").c_str()) * 1e6)] = row;
    }
    return rows;
}

/// A cell of the replay as the trace writes it: the trace holds eight digits of a float.
std::string as_in_the_trace(const std::string& cell) {
    char* end = nullptr;
    const float value = std::strtof(cell.c_str(), &end);
    if (cell.empty() || *end != '\0') {
        return cell;
    }
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.8g", static_cast<double>(value));
    return text.data();
}

/// 4 s of an axis to and fro at 200 Hz, whose friction grows by `growth` half-way.
std::string axis_motion(double growth) {
    std::ostringstream text;
    text.precision(12);
    text << "time_s,position_m,motor_force_N\n";
    for (int k = 0; k < 1600; ++k) {
        const double t = 0.005 * k;
        const double v = 0.1 * 3.0 * std::cos(3.0 * t);
        const double a = -0.1 * 9.0 * std::sin(3.0 * t);
        const double friction = (20.0 + 50.0 * std::abs(v)) * (k < 800 ? 1.0 : growth);
        const double ripple = 0.5 * std::sin(40.0 * t);
        text << t << ',' << 0.1 * std::sin(3.0 * t) << ',' << 90.0 * a + std::copysign(friction, v) + ripple << '\n';
    }
    return text.str();
}

/// A recording whose column is in another unit.
std::string with_column_times(const std::string& csv, const std::string& column, double factor) {
    std::istringstream in(csv);
    std::ostringstream out;
    std::string line;
    std::getline(in, line);
    out << line << '\n';
    const auto place = std::count(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(line.find(column)), ',');
    while (std::getline(in, line)) {
        std::istringstream cells(line);
        std::string cell;
        for (std::ptrdiff_t k = 0; std::getline(cells, cell, ','); ++k) {
            out << (k > 0 ? "," : "")
                << (k == place && !cell.empty() ? std::to_string(std::stod(cell) * factor) : cell);
        }
        out << (line.ends_with(',') ? "," : "") << '\n';
    }
    return out.str();
}

}  // namespace

TEST_GROUP(Run) {
    Inputs inputs;

    void check_ran(const Ended& ended) {
        STRCMP_EQUAL("", ended.error.c_str());
        LONGS_EQUAL(0, ended.exit_code);
    }
    void simulate_and_record() {
        check_ran(simulated());
        keep_recording();
    }
    [[nodiscard]] Ended simulated() {
        return run_millforce({"simulate", inputs.name("scenario.toml"), "--record", "--out", inputs.name("results")});
    }
    void keep_recording() {
        std::filesystem::rename(inputs.path("results") / "recording.csv", inputs.path("log.csv"));
    }
    /// Every row of the trace, all its estimates and the override, stands in the replay to the last digit.
    void check_replay_repeats_the_trace() {
        const auto replayed = rows_of(inputs.read("out.csv"));
        const auto trace = rows_of(text_of(inputs.path("results") / "trace.csv"));
        int with_immersion = 0;
        for (const auto& [time_us, row] : trace) {
            const auto found = replayed.find(time_us);
            CHECK(found != replayed.end());
            for (const auto& [name, value] : found->second) {
                if (name != "time_s") {
                    STRCMP_EQUAL(row.at(name).c_str(), as_in_the_trace(value).c_str());
                }
            }
            with_immersion += row.at("radial_immersion").empty() ? 0 : 1;
        }
        CHECK(with_immersion >= 10);
        CHECK(replayed.size() > 10 * trace.size());
    }
};

TEST(Run, simulate_writes_its_report_and_is_silent_in_a_pipe) {
    const Ended ended = run_millforce({"simulate", inputs.name("scenario.toml"), "--out", inputs.name("results")});
    check_ran(ended);
    CHECK(contains(ended.out, "report: "));
    for (const char* file : {"summary.json", "trace.csv", "trace_constant.csv", "report.html"}) {
        CHECK(std::filesystem::file_size(inputs.path("results") / file) > 100);
    }
}

TEST(Run, the_same_seed_gives_the_same_trace_and_another_seed_another) {
    const auto trace = [&](const char* seed) {
        check_ran(run_millforce({"simulate", inputs.name("scenario.toml"), "--seed", seed, "--controller", "constant",
                                 "--out", inputs.name("results")}));
        return text_of(inputs.path("results") / "trace.csv");
    };
    const std::string first = trace("7");
    CHECK(first == trace("7"));
    CHECK(first != trace("8"));
}

TEST(Run, replay_of_a_recorded_simulation_repeats_its_estimates_and_override_to_the_last_digit) {
    simulate_and_record();
    check_ran(inputs.replay({"--interval", "0"}));
    check_replay_repeats_the_trace();
}

TEST(Run, replay_with_the_programmed_feed_told_repeats_them_as_well) {
    simulate_and_record();
    inputs.write("log.csv", with(inputs.read("log.csv"), "programmed_feed_mm_s", "not_told"));
    check_ran(inputs.replay({"--interval", "0", "--programmed-feed", "1200"}));
    check_replay_repeats_the_trace();
}

TEST(Run, replay_without_an_output_file_prints_the_same_rows) {
    simulate_and_record();
    check_ran(inputs.replay());
    const Ended ended = run_millforce({"replay", inputs.name("log.csv"), "--machine", inputs.name("machine.toml"),
                                       "--tool", inputs.name("tool.toml")});
    check_ran(ended);
    CHECK(ended.out == inputs.read("out.csv"));
}

TEST(Run, replay_gives_a_row_for_each_sample_of_a_recording_at_50_hertz) {
    simulate_and_record();
    const std::string at_50_hertz = every_nth_row(inputs.read("log.csv"), 20);
    const std::size_t samples = csv_rows(at_50_hertz).size();
    CHECK(samples > 50);
    inputs.write("log.csv", at_50_hertz);
    const Ended ended = inputs.replay();
    LONGS_EQUAL(0, ended.exit_code);
    // 4000 rpm are 1.3 revolutions in 20 ms.
    CHECK(contains(ended.error, "the spindle turns by 1.4 revolutions between two samples: forces are averages"));
    LONGS_EQUAL(samples, csv_rows(inputs.read("out.csv")).size());
}

TEST(Run, replay_says_how_many_samples_of_a_slow_recording_have_no_row) {
    simulate_and_record();
    inputs.write("log.csv", every_nth_row(inputs.read("log.csv"), 13));  // 77 Hz
    const Ended ended = inputs.replay();
    LONGS_EQUAL(0, ended.exit_code);
    CHECK(contains(ended.error, "millforce: note: "));
    CHECK(contains(ended.error, "--interval 0 gives a row for each"));
    CHECK_FALSE(contains(inputs.replay({"--interval", "0"}).error, "gives a row for each"));
}

TEST(Run, replay_says_in_words_why_its_rows_say_nothing) {
    simulate_and_record();
    const std::string good = inputs.read("log.csv");
    const auto note_for = [&](const std::string& column, double factor) {
        inputs.write("log.csv", with_column_times(good, column, factor));
        return inputs.replay().error;
    };
    CHECK(contains(note_for("spindle_angle_rad", -1.0), "the spindle turns backwards"));
    CHECK(contains(note_for("spindle_angle_rad", 0.0), "the spindle does not turn"));
    CHECK(contains(note_for("spindle_angle_rad", 57.3), "or its angle is not in radians"));
}

TEST(Run, ctrl_c_in_a_long_simulation_leaves_no_file_and_a_pipe_sees_no_progress) {
    inputs.write("scenario.toml", with(scenario_text, "length_mm = 30", "length_mm = 90000"));
    Program program({"simulate", inputs.name("scenario.toml"), "--record", "--out", inputs.name("results")});
    const auto unfinished = [&] {
        std::error_code none_yet;
        return std::filesystem::directory_iterator(inputs.path("results"), none_yet) !=
               std::filesystem::directory_iterator();
    };
    for (int k = 0; k < 1000 && !unfinished(); ++k) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    // On a terminal the progress begins after half a second.
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    CHECK(unfinished());
    program.interrupt(SIGINT);
    program.wait();
    LONGS_EQUAL(SIGINT, program.ended_by_signal());
    STRCMP_EQUAL("", program.error().c_str());
    CHECK(!unfinished());
}

TEST(Run, what_calibrate_cutting_writes_is_a_table_of_tool_toml) {
    check_ran(run_millforce(
        {"calibrate", "cutting", MILLFORCE_TEST_DATA "/milling_6061_train.csv", "-o", inputs.name("c.toml")}));
    inputs.write("tool.toml", tool_head + inputs.read("c.toml"));
    CHECK(simulated().exit_code <= 1);  // coefficients of aluminium in a steel: the limit need not hold
    keep_recording();
    check_ran(inputs.replay());
    check_ran(run_millforce({"estimate", MILLFORCE_TEST_DATA "/milling_6061_train.csv", "--tool",
                             inputs.name("tool.toml"), "-o", inputs.name("estimates.csv")}));
}

TEST(Run, what_cut_table_writes_is_what_calibrate_cutting_takes) {
    check_ran(run_millforce({"cut-table", inputs.name("scenario.toml"), "-o", inputs.name("cuts.csv")}));
    check_ran(run_millforce({"calibrate", "cutting", inputs.name("cuts.csv"), "-o", inputs.name("c.toml")}));
    CHECK(contains(inputs.read("c.toml"), "cut_side = \"down\""));
}

TEST(Run, what_calibrate_friction_writes_is_a_table_of_machine_toml) {
    inputs.write("axis.csv", axis_motion(1.0));
    check_ran(
        run_millforce({"calibrate", "friction", inputs.name("axis.csv"), "--axis", "y", "-o", inputs.name("f.toml")}));
    inputs.write("machine.toml", machine_text + inputs.read("f.toml"));
    simulate_and_record();
}

TEST(Run, a_bound_that_does_not_hold_is_exit_code_1_with_the_result_written) {
    inputs.write("axis.csv", axis_motion(1.5));
    const Ended ended = run_millforce({"calibrate", "friction", inputs.name("axis.csv"), "-o", inputs.name("f.toml")});
    LONGS_EQUAL(1, ended.exit_code);
    CHECK(contains(ended.out, "BROKEN"));
    CHECK(contains(inputs.read("f.toml"), "mass_kg"));
}

TEST(Run, replay_says_that_a_spindles_current_in_air_is_not_the_machines) {
    const std::string scenario = std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/";
    check_ran(run_millforce({"simulate", scenario + "slot_entry.toml", "--record", "--out", inputs.name("slot")}));
    const std::string milliamperes =
        with_column_times(text_of(inputs.path("slot") / "recording.csv"), "spindle_current_A", 1000.0);
    inputs.write("log.csv", milliamperes);
    const Ended ended = run_millforce({"replay", inputs.name("log.csv"), "--machine", scenario + "machines/vmc.toml",
                                       "--tool", scenario + "tools/endmill_10mm.toml", "-o", inputs.name("out.csv")});
    LONGS_EQUAL(0, ended.exit_code);
    CHECK(contains(ended.error, "in air the spindle's current is not that of the machine's file; expected amperes"));
}

TEST(Run, a_machine_that_measures_its_spindle_alone_is_told_what_follows_from_it) {
    inputs.write("machine.toml", with(machine_text, "K_x4_N_per_A = 120.0", "K_x4_N_per_A = 0.0"));
    const Ended ended = simulated();
    LONGS_EQUAL(0, ended.exit_code);
    CHECK(contains(ended.error, "millforce: note: neither x nor y gives a force (K_x4_N_per_A)"));
}
