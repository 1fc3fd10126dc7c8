// SPDX-License-Identifier: Apache-2.0
#include "live_bench.hpp"
#include "program/commission_inputs.hpp"

#include <CppUTest/TestHarness.h>

#include <chrono>
#include <csignal>
#include <memory>

using namespace millforce;
using namespace millforce::vcan;
using namespace millforce::test;
using namespace std::chrono_literals;

namespace {

/// A simulated machine on vcan0, and the commissioning that measures it, as two processes in lock-step. They share
/// frames, and the programs that the commissioning writes for the machine.
class CommissioningFolder : public LiveFolder {
  public:
    CommissioningFolder() {
        write("answers.toml", commissioning_answers() + "bus.role = \"master\"\nbus.sync_period_ms = 4\n");
        write("dwell.ngc", "G21 G90\nS1200 M3\nG4 P600\nM30\n");
    }
    [[nodiscard]] std::unique_ptr<Program> commission() const {
        return std::make_unique<Program>(std::vector<std::string>{"commission", "vcan0", "--session", file("session"),
                                                                  "--answers", file("answers.toml"), "--lock-step"});
    }
    /// The machine runs a program; it goes off with the end of the program, or of the object.
    [[nodiscard]] std::unique_ptr<Program> machine(const std::string& name, const std::string& program,
                                                   double start_x_mm) const {
        write(name + ".toml", commissioning_scenario("machine.toml", program, 3, block_along_x(start_x_mm)));
        return std::make_unique<Program>(std::vector<std::string>{"simulate", file(name + ".toml"), "--bus", "vcan0",
                                                                  "--lock-step", "--out", file("out_" + name)});
    }
    [[nodiscard]] std::unique_ptr<Program> machine_for(const std::string& step, double start_x_mm) const {
        return machine(step, "session/" + step + ".ngc", start_x_mm);
    }
};

}  // namespace

TEST_GROUP(CommissionOnVcan) {
    CommissioningFolder folder;

    /// The step of the commissioning, from the request to run its program to its end. A busy computer may lose samples
    /// of a move: then the program is run again, as an operator would.
    void run_step(Program & commissioning, const std::string& step, double start_x_mm, const std::string& next) {
        bool is_done = !commissioning.prints(step + ": run ", patience);
        for (int attempt = 0; attempt < 6 && !is_done; ++attempt) {
            folder.machine_for(step, start_x_mm)->wait();
            is_done = commissioning.prints(next, 10s);
        }
        if (!contains(commissioning.out(), next)) {
            commissioning.interrupt(SIGKILL);
            commissioning.wait();
            FAIL((step + ":\n" + commissioning.out() + commissioning.error()).c_str());
        }
    }
};

TEST(CommissionOnVcan, is_killed_goes_on_and_writes_the_files_that_let_run_mill) {
    {
        const auto waiting = folder.machine("dwell", "dwell.ngc", -25.0);
        const auto killed = folder.commission();
        CHECK_TEXT(killed->prints("node 2: CiA 402 drive", patience), "the drives were not found");
        CHECK(killed->prints("idle: run ", patience));
        waiting->interrupt(SIGKILL);
        waiting->wait();
        run_step(*killed, "idle", -25.0, "idle: good enough");
        CHECK(killed->prints("air: run ", patience));
        const auto machine = folder.machine_for("air", 0.0);
        CHECK_TEXT(killed->prints("x -1442 mm/min", patience), killed->out().c_str());
        killed->interrupt(SIGKILL);
        killed->wait();
        machine->interrupt(SIGKILL);
        machine->wait();
    }
    const auto resumed = folder.commission();
    run_step(*resumed, "air", 0.0, "air: good enough");
    run_step(*resumed, "standard_x", -25.0, "fit: good enough");
    run_step(*resumed, "validation_x", -25.0, "validation: good enough");
    resumed->wait();
    CHECK_EQUAL_TEXT(0, resumed->exit_code(), (resumed->out() + resumed->error()).c_str());
    CHECK_FALSE(contains(resumed->out(), "idle: run "));
    const std::string machine_file = folder.text("session/machine.toml");
    // The plant's own: 0.70 N·m/A and 120 N/A. The drives' plates say 1.0 N·m/A, and 1257 N/A.
    DOUBLES_EQUAL(0.70, toml_value(machine_file, "spindle", "K_t1_Nm_per_A"), 0.02);
    DOUBLES_EQUAL(120.0, toml_value(machine_file, "x", "K_x4_N_per_A"), 4.0);

    // The files in use: a wider and deeper cut than any of the commissioning.
    folder.write("part.ngc", "G21 G90 G94\nS4800 M3\nG0 Z5\nG0 X-12 Y1\nG0 Z-9\nG1 X30 F1600\nG0 Z5\nM30\n");
    Program run({"run", "vcan0", "--machine", folder.file("session/machine.toml"), "--tool",
                 folder.file("session/tool.toml"), "--log", folder.file("run.jsonl"), "--lock-step"});
    const auto milling = folder.machine("part", "part.ngc", -25.0);
    milling->wait();
    run.interrupt(SIGINT);
    run.wait();
    CHECK_EQUAL_TEXT(0, run.exit_code(), run.error().c_str());
    CHECK_EQUAL_TEXT(0, milling->exit_code(), (milling->out() + milling->error()).c_str());
    const std::string log = folder.text("run.jsonl");
    CHECK(contains(log, "\"state\":\"in_cut\""));
    CHECK_FALSE(contains(log, "\"state\":\"fault\""));
}
