// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "commission/answers.hpp"
#include "commission/cut_watch.hpp"
#include "estimation/cutting/cut_geometry.hpp"

namespace millforce::host {

/// What the machine is to do: speeds, feeds and cuts, in the order of the programs.
struct CommissionPlan {
    std::vector<std::string> axes;
    std::vector<double> idle_rpm;
    double idle_dwell_s = 0.0;
    std::vector<double> air_feeds_mm_min;
    double air_travel_mm = 0.0;
    double air_rpm = 0.0;
    double cut_rpm = 0.0;
    double tool_diameter_mm = 0.0;
    int flutes = 0;
    double travel_per_motor_turn_mm = 0.0;  ///< the largest of the axes
    std::vector<CutPass> standard;
    std::vector<CutPass> validation;
    estimation::CutSide side = estimation::CutSide::down;
    std::filesystem::path database;
    std::string entry;
};

/// Asks for what the programs take. The standard cuts are Kim & Chung's: five feeds, then two more widths at the middle
/// one. The validation has other feeds and widths within theirs.
CommissionPlan plan_of(Answers& answers, const std::vector<std::string>& axes);

/// Programs for the CNC (G-code, mm): idling, air, and cuts along `axis` ("x" or "y").
std::string idle_program(const CommissionPlan& plan);
std::string air_program(const CommissionPlan& plan);
/// With M3: the origin is the corner of the block where its face towards +y (passes along x) or −x (along y) begins, on
/// its top. Down milling goes in +, up milling comes back in −.
std::string cut_program(const CommissionPlan& plan, const std::string& axis, const std::vector<CutPass>& passes);
/// Of the block, for the operator: length along the passes, and what they take off its face.
double block_length_mm(const CommissionPlan& plan);

}  // namespace millforce::host
