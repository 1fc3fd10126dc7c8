// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "commission/first_files.hpp"

namespace millforce::host {

namespace {

constexpr const char* given = "given";
constexpr const char* data_sheet = "from the data sheet: known to 10 %";
constexpr double data_sheet_relative_sd = 0.1;

/// A data sheet does not know more.
double four_digits(double value) {
    return std::stod(fmt::format("{:.4g}", value));
}

/// Asks for a key of the file and sets it.
void ask(FileDraft& draft, Answers& answers, const std::string& table, const std::string& key,
         const NumberQuestion& question) {
    NumberQuestion of_key = question;
    of_key.key = table + "." + key;
    const double value = answers.number(of_key);
    if (std::isnan(value)) {
        return;
    }
    const std::string source = value == of_key.usual ? "" : given;
    if (of_key.is_whole) {
        draft.set_integer(table, key, static_cast<std::int64_t>(value), source);
    } else {
        draft.set(table, key, value, source);
    }
}

void set_known(FileDraft& draft, const std::string& table, const std::string& key, double value,
               const std::string& source) {
    if (std::isfinite(value)) {
        draft.set(table, key, four_digits(value), source);
    }
}

void add_spindle(FileDraft& draft, Answers& answers) {
    ask(draft, answers, "spindle", "rated_current_A",
        {"", "Spindle motor: rated current by its plate", "A rms", 0.01, 1e4});
    if (answers.has("spindle.K_t1_Nm_per_A")) {
        ask(draft, answers, "spindle", "K_t1_Nm_per_A", {"", "Spindle torque per ampere", "N·m/A", 1e-4, 1e4});
    } else {
        const double torque_Nm =
            answers.number({"spindle.rated_torque_Nm", "Spindle motor: rated torque by its plate", "N·m", 1e-3, 1e5});
        const double rated_A = answers.number(
            {"spindle.rated_torque_current_A", "Spindle motor: current at that torque", "A rms", 0.01, 1e4});
        const double ratio = answers.number(
            {"spindle.motor_turns_per_turn", "Turns of the motor per turn of the spindle", "", 0.01, 100.0, 1.0});
        set_known(draft, "spindle", "K_t1_Nm_per_A", ratio * torque_Nm / rated_A, data_sheet);
    }
    draft.set("spindle", "gain_relative_sd", data_sheet_relative_sd, "no cut has measured it yet");
    const double base_rpm =
        answers.number({"spindle.base_speed_rpm", "Speed above which the torque falls (field weakening), 0: none",
                        "1/min", 0.0, 190e3, 0.0});
    if (base_rpm > 0.0) {
        draft.set("spindle", "base_speed_rad_s", base_rpm * std::numbers::pi / 30.0, data_sheet);
    }
    ask(draft, answers, "spindle", "encoder_counts_per_rev",
        {"", "Counts of the spindle's encoder per turn, after quadrature", "", 16.0, 1048576.0, {}, true});
}

void add_axis(FileDraft& draft, Answers& answers, const std::string& axis) {
    if (answers.has(axis + ".K_x4_N_per_A")) {
        ask(draft, answers, axis, "K_x4_N_per_A", {"", axis + ": force per ampere", "N/A", 0.0, 1e5});
    } else {
        const double constant =
            answers.number({axis + ".torque_constant_Nm_per_A", axis + " motor: torque constant by its data sheet",
                            "N·m/A rms", 1e-4, 1e4});
        const double lead_mm = answers.number({axis + ".travel_per_motor_turn_mm",
                                               axis + ": travel per turn of the motor (screw lead)", "mm", 0.01, 1e3});
        // A turn of the motor does 2π T of work.
        set_known(draft, axis, "K_x4_N_per_A", 2.0 * std::numbers::pi * 1e3 * constant / lead_mm, data_sheet);
    }
    draft.set(axis, "gain_relative_sd", data_sheet_relative_sd, "no cut has measured it yet");
    ask(draft, answers, axis, "mass_kg",
        {"", axis + ": moved mass, the motor's inertia reflected", "kg", 0.0, 1e5, 0.0});
    ask(draft, answers, axis, "rated_current_A", {"", axis + " motor: rated current", "A rms", 0.01, 1e4});
}

void add_cnc(FileDraft& draft, Answers& answers, bool is_can) {
    ask(draft, answers, "cnc", "override_min", {"", "Smallest feed override that may be set", "", 0.0, 1.0, 0.1});
    ask(draft, answers, "cnc", "override_max",
        {"", "Largest feed override that the CNC accepts", "", 0.1, 9.0, is_can ? 2.0 : 1.0});
    ask(draft, answers, "cnc", "acceleration_mm_s2", {"", "Acceleration limit of the path", "mm/s²", 1.0, 1e6, 1000.0});
}

const char* words_of_drive(const std::string& drive) {
    return drive == "spindle" ? "spindle drive" : drive == "x" ? "x drive" : drive == "y" ? "y drive" : "z drive";
}

/// CiA 402: velocity or position, current, status word.
void add_drive(FileDraft& draft, Answers& answers, const std::string& drive, bool is_master) {
    const std::string table = "bus." + drive;
    ask(draft, answers, table, "node_id",
        {"", fmt::format("CANopen node of the {}", words_of_drive(drive)), "", 1.0, 127.0, {}, true});
    const bool is_spindle = drive == "spindle";
    draft.set_texts(table, "tpdo1", {is_spindle ? "0x6064:32" : "0x606C:32", "0x6078:16", "0x6041:16"});
    draft.set_flag(table, "write_mapping", is_master);
    if (is_spindle && answers.word({"bus.spindle.index_latch",
                                    "Spindle drive: latches the index pulse (0x60BA, 0x60D5)",
                                    {"true", "false"},
                                    "false"}) == "true") {
        draft.set_texts(table, "tpdo2", {"0x60BA:32", "0x60D5:16"});
        draft.set_integer(table, "tpdo2_every", 4);
        draft.set_text(table, "index_count_object", "0x60BA");
        draft.set_text(table, "index_number_object", "0x60D5");
    }
    if (!is_spindle) {
        ask(draft, answers, table, "velocity_mm_s_per_unit",
            {"",
             fmt::format("{}: one unit of its velocity 0x606C; negative: counts against the axis",
                         words_of_drive(drive)),
             "mm/s", -1e4, 1e4, 0.001});
    }
    if (is_master) {
        draft.set(table, "heartbeat_period_ms", 50.0);
        draft.set(table, "heartbeat_timeout_ms", 500.0);
    }
}

Connection asked_connection(Answers& answers) {
    const WordQuestion question{"machine.connection",
                                "How the drives are read: can: CiA 402 on a CAN bus, hal: LinuxCNC",
                                {"can", "hal"},
                                "can"};
    return answers.word(question) == "can" ? Connection::can : Connection::hal;
}

}  // namespace

std::vector<std::string> axes_of(Answers& answers) {
    const std::string letters = answers.word(
        {"machine.axes", "Feed axes with a current that can be read", {"xyz", "xy", "xz", "yz", "x", "y"}, "xyz"});
    std::vector<std::string> axes;
    for (const char letter : letters) {
        axes.emplace_back(1, letter);
    }
    return axes;
}

void add_bus(FileDraft& draft, Answers& answers, const std::vector<std::string>& axes) {
    const bool is_master =
        answers.word({"bus.role",
                      "Who starts the drives and sends SYNC: master: this controller, listener: the CNC",
                      {"listener", "master"},
                      "listener"}) == "master";
    const double period_ms = answers.number({"bus.sync_period_ms", "Time between two SYNCs", "ms", 0.1, 1000.0, 1.0});
    draft.set_text("bus", "role", is_master ? "master" : "listener", given);
    draft.set_flag("bus", "produces_sync", is_master);
    set_known(draft, "bus", "sync_period_ms", period_ms, given);
    set_known(draft, "bus", "collect_time_ms", 0.9 * period_ms, "");
    set_known(draft, "cnc", "sample_rate_hz", 1000.0 / period_ms, "one sample per SYNC");
    set_known(draft, "cnc", "stale_s", std::max(0.1, 0.02 * period_ms), "");
    add_drive(draft, answers, "spindle", is_master);
    for (const std::string& axis : axes) {
        add_drive(draft, answers, axis, is_master);
    }
}

FileDraft first_machine_file(Answers& answers, std::optional<Connection> connection) {
    FileDraft draft(firmware::ParameterFile::machine);
    draft.set_heading("name", answers.word({"machine.name", "Name of the machine", {}, "machine"}));
    draft.set_heading("description", "From data sheets, by 'millforce init': not measured yet");
    const bool is_can = (connection ? *connection : asked_connection(answers)) == Connection::can;
    const std::vector<std::string> axes = axes_of(answers);
    add_spindle(draft, answers);
    for (const std::string& axis : axes) {
        add_axis(draft, answers, axis);
    }
    add_cnc(draft, answers, is_can);
    if (is_can) {
        add_bus(draft, answers, axes);
    } else {
        ask(draft, answers, "cnc", "sample_rate_hz", {"", "Rate of LinuxCNC's servo thread", "1/s", 10.0, 1e5, 1000.0});
    }
    return draft;
}

}  // namespace millforce::host
