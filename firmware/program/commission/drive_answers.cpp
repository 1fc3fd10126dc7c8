// SPDX-License-Identifier: Apache-2.0
#include "commission/drive_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "files/input_error.hpp"
#include "files/toml_writer.hpp"

namespace millforce::host {

namespace {

std::string answers_of_one(const FoundDrive& drive, const std::string& role, Answers& answers) {
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
    const double travel_mm = answers.number(
        {role + ".travel_per_motor_turn_mm", role + ": travel per turn of the motor (screw lead)", "mm", 0.01, 1e3});
    if (const auto unit = drive.velocity_mm_s(travel_mm)) {
        text += fmt::format("bus.{}.velocity_mm_s_per_unit = {}\n", role, toml_number(*unit));
    }
    return text;
}

}  // namespace

std::string answers_of_drives(const std::vector<FoundDrive>& drives, const std::vector<std::string>& axes,
                              Answers& answers) {
    if (drives.empty()) {
        throw InputError("no node answers on this bus; expected drives with CANopen, powered, at this bit rate");
    }
    std::string text;
    std::vector<std::string> roles{"spindle"};
    roles.insert(roles.end(), axes.begin(), axes.end());
    for (std::size_t place = 0; place < roles.size(); ++place) {
        const std::string& role = roles[place];
        const auto usual = place < drives.size() ? std::optional<double>(drives[place].node_id) : std::nullopt;
        const auto node = answers.integer(
            {"bus." + role + ".node_id", fmt::format("Node of the {} drive", role), "", 1.0, 127.0, usual});
        if (node == 0) {
            throw InputError(fmt::format(
                "bus.{0}.node_id: missing: only {1} of {2} nodes answer on this bus; expected the {0} drive powered",
                role, drives.size(), roles.size()));
        }
        const auto found =
            std::find_if(drives.begin(), drives.end(), [&](const FoundDrive& drive) { return drive.node_id == node; });
        if (found == drives.end() || !found->is_cia402()) {
            throw InputError(fmt::format("bus.{}.node_id = {}: no CiA 402 drive answers there", role, node));
        }
        text += fmt::format("bus.{}.node_id = {}\n", role, node) + answers_of_one(*found, role, answers);
    }
    return text;
}

}  // namespace millforce::host
