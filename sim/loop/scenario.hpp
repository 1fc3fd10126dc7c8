// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cutting/cutting_force.hpp"
#include "firmware/parameter_block.hpp"
#include "firmware/parameters.hpp"
#include "machine/machine_plant.hpp"

namespace millforce::sim {

/// How the workpiece is given: as a block of stock with a part program, or as depth and width along a straight path.
struct StockBox {
    double min_x_mm = 0.0;
    double min_y_mm = 0.0;
    double max_x_mm = 0.0;
    double max_y_mm = 0.0;
    double top_start_mm = 0.0;  ///< height at min_x
    double top_end_mm = 0.0;    ///< height at max_x: a sloping top
};

struct StockCylinder {
    double x_mm = 0.0;
    double y_mm = 0.0;
    double diameter_mm = 0.0;
    double top_mm = 0.0;
};

struct StockSettings {
    StockBox block{};
    double cell_mm = 0.1;
    std::vector<StockBox> boxes;         ///< set the height within their rectangle, in order
    std::vector<StockCylinder> drilled;  ///< set the height within their circle
    double start_x_mm = 0.0;
    double start_y_mm = 0.0;
    double start_z_mm = 50.0;

    /// The blank with all that is on it and in it lies elsewhere.
    void move_by(double x_mm, double y_mm);
};

struct ProfilePoint {
    double path_mm = 0.0;
    double axial_depth_mm = 0.0;
    double radial_width_mm = 0.0;
    double feed_mm_s = 0.0;  ///< programmed from here on; 0: as before
};

struct ProfileSettings {
    std::vector<ProfilePoint> points;
    bool linear = false;  ///< between points; else each point holds until the next
    double length_mm = 0.0;
    double direction_deg = 0.0;  ///< direction of the straight path in machine x, y
};

/// How the plant differs from what the controller believes. All of it is written into the report.
struct PlantDeviation {
    double cutting_force_scale = 1.0;  ///< K_s true / K_s of the coefficients in the scenario
    double radial_force_scale = 1.0;   ///< r_1 true / r_1 of the coefficients in the scenario
    double size_effect_shift = 0.0;    ///< added to the exponent of K_s over chip thickness, K_s fixed at the pivot
    double radial_size_effect_shift = 0.0;  ///< added to the exponent of r_1 over chip thickness
    double size_effect_pivot_mm = 1.0;
    double friction_scale = 1.0;        ///< factor on the friction of the feed drives and the spindle bearing
    double current_noise_share = 0.01;  ///< share of the rated current, per sample
    double spindle_gain_scale = 1.0;    ///< torque constant true / believed
    double axis_gain_scale = 1.0;       ///< force constant true / believed
};

/// Who reads the part program: this project's reader, LinuxCNC's rs274, or the former and, where it refuses, the
/// latter.
enum class Interpreter { automatic, own, rs274 };

/// A cutter under the number by which a part program calls it.
struct NumberedCutter {
    std::uint32_t number = 0;
    Cutter cutter{};
};

struct Scenario {
    std::string name;
    std::string title;
    std::string description;
    std::string machine_file;
    std::string tool_file;
    std::string material;
    std::uint64_t seed = 1;

    double spindle_speed_rad_s = 0.0;  ///< profile scenarios; a part program has its own S words
    double feed_mm_s = 0.0;            ///< programmed feed of profile scenarios
    std::string program_file;          ///< part program; empty: profile
    Interpreter interpreter = Interpreter::automatic;
    StockSettings stock{};
    ProfileSettings profile{};

    Cutter cutter{};
    std::vector<NumberedCutter> numbered_cutters{};  ///< of a program that changes its tool: preview_of_tools() alone
    CuttingCoefficients coefficients{};
    CuttingForceOptions cutting_options{};
    PlantDeviation deviation{};
    MachinePlantSettings machine{};

    firmware::Parameters<float> parameters{};  ///< what the controller believes: machine.toml and tool.toml

    [[nodiscard]] bool has_program() const { return !program_file.empty(); }
};

/// Reads a scenario and the machine, tool and program files that it names (relative to its own folder).
/// Throws InputError.
Scenario read_scenario(const std::string& path);

/// A part program on the [stock] of a TOML file (its other tables may hold anything), cut with the tool of a tool.toml:
/// what geometry needs, and no more. Throws InputError.
Scenario read_part(const std::string& program_path, const std::string& stock_path, const std::string& tool_path);

/// The same for a program that changes its tool. Each is an end mill: no table [cutter].
Scenario read_part_of_tools(const std::string& program_path, const std::string& stock_path,
                            const std::vector<firmware::NumberedTool>& tools);

/// Puts the deviation into the plant's settings, and the seed. Called once before a run.
Scenario deviated(const Scenario& scenario, const PlantDeviation& deviation, std::uint64_t seed);

}  // namespace millforce::sim
