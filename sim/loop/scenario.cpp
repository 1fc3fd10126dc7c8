// SPDX-License-Identifier: Apache-2.0
#include "loop/scenario.hpp"

#include <filesystem>

#include "cutting/angle_units.hpp"
#include "cutting/oblique_cutting.hpp"
#include "files/input_error.hpp"
#include "files/toml_reader.hpp"
#include "loop/machine_kind.hpp"
#include "parameters/parameter_files.hpp"

namespace millforce::sim {

namespace {

using Table = host::TomlFile::Table;

StockBox read_box(Table& table) {
    StockBox box;
    box.min_x_mm = table.number("min_x_mm", -1e4, 1e4);
    box.min_y_mm = table.number("min_y_mm", -1e4, 1e4);
    box.max_x_mm = table.number("max_x_mm", box.min_x_mm, 1e4);
    box.max_y_mm = table.number("max_y_mm", box.min_y_mm, 1e4);
    box.top_start_mm = table.number("top_mm", -1e3, 1e3, 0.0);
    box.top_end_mm = table.number("top_end_mm", -1e3, 1e3, box.top_start_mm);
    return box;
}

void move_box(StockBox& box, double x_mm, double y_mm) {
    box.min_x_mm += x_mm;
    box.max_x_mm += x_mm;
    box.min_y_mm += y_mm;
    box.max_y_mm += y_mm;
}

void read_stock(Table& root, StockSettings& stock) {
    Table table = root.table("stock");
    stock.block = read_box(table);
    stock.cell_mm = table.number("cell_mm", 0.01, 5.0, 0.1);
    stock.start_x_mm = table.number("start_x_mm", -1e4, 1e4, 0.0);
    stock.start_y_mm = table.number("start_y_mm", -1e4, 1e4, 0.0);
    stock.start_z_mm = table.number("start_z_mm", -1e4, 1e4, 50.0);
    for (Table& box : table.tables("box")) {
        stock.boxes.push_back(read_box(box));
        box.reject_unknown_keys();
    }
    for (Table& hole : table.tables("drilled")) {
        stock.drilled.push_back({hole.number("x_mm", -1e4, 1e4), hole.number("y_mm", -1e4, 1e4),
                                 hole.number("diameter_mm", 0.01, 1e3), hole.number("top_mm", -1e3, 1e3)});
        hole.reject_unknown_keys();
    }
    table.reject_unknown_keys();
}

void read_profile(Table& root, Scenario& scenario) {
    Table table = root.table("profile");
    scenario.spindle_speed_rad_s = table.number("spindle_speed_rpm", 1.0, 1e5) * rad_s_per_rpm;
    scenario.feed_mm_s = table.number("feed_mm_min", 1.0, 1e5) / 60.0;
    scenario.profile.length_mm = table.number("length_mm", 0.1, 1e5);
    scenario.profile.linear = table.choice("interpolation", {"step", "linear"}, 0) == 1;
    scenario.profile.direction_deg = table.number("direction_deg", -360.0, 360.0, 0.0);
    double last_mm = -1.0;
    for (Table& point : table.tables("point")) {
        ProfilePoint p;
        p.path_mm = point.number("path_mm", 0.0, 1e5);
        if (p.path_mm < last_mm) {
            point.fail("path_mm", "expected points in the order of the path");
        }
        last_mm = p.path_mm;
        p.axial_depth_mm = point.number("axial_depth_mm", 0.0, 500.0);
        p.radial_width_mm = point.number("radial_width_mm", 0.0, scenario.cutter.diameter_mm);
        p.feed_mm_s = point.number("feed_mm_min", 0.0, 1e5, 0.0) / 60.0;
        point.reject_unknown_keys();
        scenario.profile.points.push_back(p);
    }
    if (scenario.profile.points.empty()) {
        table.fail("point", "missing, expected at least one [[profile.point]]");
    }
    table.reject_unknown_keys();
}

Cutter end_mill_of(const firmware::ToolParameters<float>& tool) {
    Cutter cutter;
    cutter.type = CutterType::end_mill;
    cutter.teeth = tool.teeth;
    cutter.diameter_mm = static_cast<double>(tool.diameter_mm);
    cutter.flute_length_mm = static_cast<double>(tool.flute_length_mm);
    cutter.helix_rad = static_cast<double>(tool.helix_deg) * degree;
    return cutter;
}

void read_cutter(Table& root, const firmware::ToolParameters<float>& tool, Cutter& cutter) {
    Table table = root.table("cutter");
    constexpr CutterType types[] = {CutterType::end_mill, CutterType::face_mill, CutterType::ball_end_mill};
    cutter = end_mill_of(tool);
    cutter.type = types[table.choice("type", {"end_mill", "face_mill", "ball_end_mill"}, 0)];
    cutter.helix_rad = table.number("helix_deg", 0.0, 60.0, static_cast<double>(tool.helix_deg)) * degree;
    cutter.rake_rad = table.number("rake_deg", -30.0, 30.0, 8.0) * degree;
    cutter.lead_angle_rad = table.number("lead_angle_deg", 10.0, 90.0, 90.0) * degree;
    cutter.runout_mm = table.number("runout_um", 0.0, 500.0, 0.0) * 1e-3;
    cutter.runout_angle_rad = table.number("runout_angle_deg", -360.0, 360.0, 30.0) * degree;
    table.reject_unknown_keys();
}

void read_material(Table& root, Scenario& scenario) {
    Table table = root.table("material");
    scenario.material = table.text("name", "not stated");
    if (table.has("shear_stress_N_mm2")) {
        ObliqueCut cut;
        cut.shear_stress_N_mm2 = table.number("shear_stress_N_mm2", 1.0, 1e4);
        cut.shear_angle_rad = table.number("shear_angle_deg", 5.0, 60.0) * degree;
        cut.friction_angle_rad = table.number("friction_angle_deg", 0.0, 60.0) * degree;
        cut.rake_rad = scenario.cutter.rake_rad;
        cut.inclination_rad = scenario.cutter.helix_rad;
        scenario.coefficients = oblique_cutting(cut);
    } else {
        scenario.coefficients.K_tc_N_mm2 = table.number("K_tc_N_mm2", 1.0, 1e5);
        scenario.coefficients.K_rc_N_mm2 = table.number("K_rc_N_mm2", -1e5, 1e5);
        scenario.coefficients.K_ac_N_mm2 = table.number("K_ac_N_mm2", -1e5, 1e5, 0.0);
    }
    scenario.coefficients.K_te_N_mm = table.number("K_te_N_mm", 0.0, 1e4, 0.0);
    scenario.coefficients.K_re_N_mm = table.number("K_re_N_mm", 0.0, 1e4, 0.0);
    scenario.coefficients.K_ae_N_mm = table.number("K_ae_N_mm", -1e4, 1e4, 0.0);
    SizeEffect& size = scenario.coefficients.size_effect;
    size.tangential_exponent = table.number("size_effect_exponent", -0.9, 0.5, 0.0);
    size.radial_exponent = table.number("size_effect_radial_exponent", -0.9, 0.5, size.tangential_exponent);
    size.axial_exponent = size.tangential_exponent;
    size.reference_mm = table.number("size_effect_reference_mm", 1e-4, 10.0, 1.0);
    constexpr ChipModel models[] = {ChipModel::circular, ChipModel::offset_circle, ChipModel::trochoidal};
    scenario.cutting_options.chip_model =
        models[table.choice("chip_model", {"circular", "offset_circle", "trochoidal"}, 2)];
    table.reject_unknown_keys();
}

/// What the operation requires of the controller in addition to the tool's settings.
void read_operation(Table& root, firmware::ToolParameters<float>& tool) {
    control::FeedControllerParameters<float>& control = tool.control;
    Table table = root.table("operation");
    const auto read = [&](const char* key, float& value, double low, double high) {
        value = static_cast<float>(table.number(key, low, high, static_cast<double>(value)));
    };
    read("surge_radial_immersion", control.surge_radial_immersion, 0.0, 2.0);
    read("depth_step_ratio", control.depth_step_ratio, 1.0, 10.0);
    read("proven_override", control.proven_override, 0.0, 10.0);
    read("safe_override", control.safe_override, 0.0, 10.0);
    read("caution_sd", control.caution_sd, 0.0, 4.0);
    read("turn_radial_immersion", control.turn_radial_immersion, 0.0, 2.0);
    read("turn_travel_mm", control.turn_travel_mm, 0.0, 1e3);
    read("entry_feed_per_tooth_mm", control.entry_feed_per_tooth_mm, 1e-4, 10.0);
    read("declared_axial_depth_mm", tool.declared_axial_depth_mm, 0.0, 300.0);
    read("exit_travel_mm", control.exit_travel_mm, 0.0, 1e3);
    read("air_feed_per_tooth_mm", control.air_feed_per_tooth_mm, 1e-4, 10.0);
    table.reject_unknown_keys();
}

/// A force sensor under the workpiece, in addition to the drives. Its low-pass is that of the tool's parameters.
void read_force_sensor(Table& root, Scenario& scenario) {
    if (!root.has("force_sensor")) {
        return;
    }
    Table table = root.table("force_sensor");
    ForceSensorSettings& sensor = scenario.machine.force_sensor;
    sensor.noise_N = table.number("noise_N", 0.0, 1e4, sensor.noise_N);
    sensor.zero_drift_N = table.number("zero_drift_N", 0.0, 1e4, sensor.zero_drift_N);
    sensor.resolution_N = table.number("resolution_N", 0.0, 1e3, sensor.resolution_N);
    sensor.low_pass_hz = static_cast<double>(scenario.parameters.tool.force_sensor.low_pass_hz);
    if (!(sensor.low_pass_hz > 0.0)) {
        table.fail("noise_N", "a force sensor without its low-pass, expected low_pass_hz in the tool's [force_sensor]");
    }
    table.reject_unknown_keys();
}

void read_deviation(Table& root, PlantDeviation& deviation) {
    Table table = root.table("plant");
    deviation.cutting_force_scale = table.number("cutting_force_scale", 0.1, 10.0, 1.0);
    deviation.radial_force_scale = table.number("radial_force_scale", 0.1, 10.0, 1.0);
    deviation.friction_scale = table.number("friction_scale", 0.0, 10.0, 1.0);
    deviation.current_noise_share = table.number("current_noise_share", 0.0, 0.5, 0.01);
    deviation.spindle_gain_scale = table.number("spindle_gain_scale", 0.1, 10.0, 1.0);
    deviation.axis_gain_scale = table.number("axis_gain_scale", 0.1, 10.0, 1.0);
    table.reject_unknown_keys();
}

/// K (h/h_0)^e becomes K (h/h_0)^e (h/h_p)^δ, h_p the pivot: the same form with another K and e.
void tilt(CuttingCoefficients& k, const PlantDeviation& deviation) {
    const double shift = deviation.size_effect_shift;
    const double radial_shift = shift + deviation.radial_size_effect_shift;
    const double reference_in_pivots = k.size_effect.reference_mm / deviation.size_effect_pivot_mm;
    k.K_tc_N_mm2 *= std::pow(reference_in_pivots, shift);
    k.K_ac_N_mm2 *= std::pow(reference_in_pivots, shift);
    k.K_rc_N_mm2 *= std::pow(reference_in_pivots, radial_shift);
    k.size_effect.tangential_exponent += shift;
    k.size_effect.axial_exponent += shift;
    k.size_effect.radial_exponent += radial_shift;
}

void read_stock_of(Table& root, const std::string& file, StockSettings& stock) {
    if (!root.has("stock")) {
        throw host::InputError(file + ": no table [stock]");
    }
    read_stock(root, stock);
}

}  // namespace

void StockSettings::move_by(double x_mm, double y_mm) {
    move_box(block, x_mm, y_mm);
    for (StockBox& box : boxes) {
        move_box(box, x_mm, y_mm);
    }
    for (StockCylinder& hole : drilled) {
        hole.x_mm += x_mm;
        hole.y_mm += y_mm;
    }
}

Scenario read_scenario(const std::string& path) {
    host::TomlFile file = host::TomlFile::open(path);
    Table root = file.root();
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    Scenario scenario;
    scenario.name = std::filesystem::path(path).stem().string();
    scenario.title = root.text("title", scenario.name);
    scenario.description = root.text("description", "");
    scenario.machine_file = (folder / root.text("machine")).string();
    scenario.tool_file = (folder / root.text("tool")).string();
    scenario.seed = static_cast<std::uint64_t>(root.number("seed", 0.0, 4e9, 1.0));
    scenario.parameters = host::read_parameters(scenario.machine_file, scenario.tool_file);
    read_cutter(root, scenario.parameters.tool, scenario.cutter);
    read_material(root, scenario);
    read_deviation(root, scenario.deviation);
    read_operation(root, scenario.parameters.tool);
    read_force_sensor(root, scenario);
    read_load_meter(root, scenario.machine.load_meter);
    const std::string program = root.text("program", "");
    if (program.empty()) {
        read_profile(root, scenario);
    } else {
        scenario.program_file = (folder / program).string();
        read_stock(root, scenario.stock);
    }
    root.reject_unknown_keys();
    scenario.machine.encoder_counts_per_rev = scenario.parameters.machine.encoder_counts_per_rev;
    return scenario;
}

Scenario read_part(const std::string& program_path, const std::string& stock_path, const std::string& tool_path) {
    Scenario scenario;
    scenario.name = std::filesystem::path(program_path).stem().string();
    scenario.title = scenario.name;
    scenario.tool_file = tool_path;
    scenario.program_file = program_path;
    scenario.parameters.tool = host::read_tool_parameters(tool_path);
    host::TomlFile file = host::TomlFile::open(stock_path);
    Table root = file.root();
    read_cutter(root, scenario.parameters.tool, scenario.cutter);
    read_stock_of(root, stock_path, scenario.stock);
    return scenario;
}

Scenario read_part_of_tools(const std::string& program_path, const std::string& stock_path,
                            const std::vector<firmware::NumberedTool>& tools) {
    Scenario scenario;
    scenario.program_file = program_path;
    host::TomlFile file = host::TomlFile::open(stock_path);
    Table root = file.root();
    if (root.has("cutter")) {
        throw host::InputError(stock_path + ": table [cutter], expected none with --tools: each tool is an end mill");
    }
    for (const firmware::NumberedTool& tool : tools) {
        scenario.numbered_cutters.push_back({tool.number, end_mill_of(tool.parameters)});
    }
    read_stock_of(root, stock_path, scenario.stock);
    return scenario;
}

Scenario deviated(const Scenario& scenario, const PlantDeviation& deviation, std::uint64_t seed) {
    Scenario result = scenario;
    result.deviation = deviation;
    result.seed = seed;
    CuttingCoefficients& k = result.coefficients;
    for (double* value : {&k.K_tc_N_mm2, &k.K_rc_N_mm2, &k.K_ac_N_mm2, &k.K_te_N_mm, &k.K_re_N_mm, &k.K_ae_N_mm}) {
        *value *= deviation.cutting_force_scale;
    }
    k.K_rc_N_mm2 *= deviation.radial_force_scale;
    k.K_re_N_mm *= deviation.radial_force_scale;
    tilt(k, deviation);
    result.machine.seed = seed;
    result.machine.current_noise_share = deviation.current_noise_share;
    result.machine.spindle.friction_scale = deviation.friction_scale;
    result.machine.spindle.torque_constant_Nm_per_A *= deviation.spindle_gain_scale;
    for (FeedPlantSettings& axis : result.machine.axes) {
        axis.friction_scale = deviation.friction_scale;
        axis.force_constant_N_per_A *= deviation.axis_gain_scale;
    }
    return result;
}

}  // namespace millforce::sim
