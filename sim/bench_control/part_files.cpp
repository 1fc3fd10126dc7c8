// SPDX-License-Identifier: Apache-2.0
#include "bench_control/part_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "bench_control/bench_assets.hpp"
#include "bench_control/part_program.hpp"
#include "bench_control/text_file.hpp"
#include "commission/tooth_force_advice.hpp"
#include "estimation/cutting/cutting_law.hpp"
#include "parameters/parameter_files.hpp"

namespace millforce::sim {

namespace {

/// What a tooth carries grows with the diameter; a big tool's is as high as a slot leaves torque to the spindle.
double tooth_force_limit_N(double diameter_mm) {
    return std::min(70.0 * diameter_mm, 19000.0 / diameter_mm);
}

/// What its chip space takes.
double largest_feed_per_tooth_mm(const BenchPart& part) {
    return 0.02 * part.tool_diameter_mm;
}

constexpr double stated_runout_um = 6.0;

/// What `millforce init` advises to one who knows the deepest cut of the part.
double entry_feed_per_tooth_mm(const BenchPart& part, const estimation::CuttingLaw<double>& law) {
    host::ToothForceQuestion question;
    question.teeth = part.teeth;
    question.deepest_cut_mm = part.depth_mm;
    question.largest_feed_per_tooth_mm = largest_feed_per_tooth_mm(part);
    question.law = law;
    return host::entry_feed_per_tooth_mm(question, tooth_force_limit_N(part.tool_diameter_mm), 1e-3 * stated_runout_um);
}

estimation::CuttingLaw<double> calibrated_law() {
    estimation::CuttingLaw<double> law;
    law.k_s_N_per_mm2 = 1688.3;
    law.k_1 = 0.4012;
    law.K_te_N_per_mm = 21.73;
    law.K_re_N_per_mm = 27.73;
    law.K_s_relative_sd = 0.15;
    return law;
}

/// An end mill of its diameter, with the cutting law that was calibrated for 10 mm: edge and steel are the same.
std::string tool_text(const BenchPart& part) {
    const double d = part.tool_diameter_mm;
    const estimation::CuttingLaw<double> law = calibrated_law();
    const double entry_mm = entry_feed_per_tooth_mm(part, law);
    return fmt::format(
        "# SPDX-License-Identifier: Apache-2.0\n"
        "name = \"{}_tool\"\n"
        "description = \"Carbide end mill, Ø{:g} mm, {} flutes, in SM45C\"\n\n"
        "[tool]\nteeth = {}\ndiameter_mm = {:g}\nhelix_deg = 30.0\nflute_length_mm = {:.1f}\nside = \"{}\"\n"
        "runout_um = {:g}\ntooth_force_limit_N = {:.0f}\n\n"
        "[cutting]\nk_s_N_per_mm2 = {:g}\nk_1 = {:g}\nK_te_N_per_mm = {:g}\nK_re_N_per_mm = {:g}\n"
        "K_s_relative_sd = {:g}\nK_s_exponent_sd = 0.0386\nr_1_relative_sd = 0.05\nr_1_exponent_sd = 0.0443\n"
        "reference_chip_thickness_mm = 0.4335\nminimum_chip_thickness_mm = 0.0070\n"
        "maximum_chip_thickness_mm = 0.1445\n\n"
        "[control]\nsetpoint_share = 0.97\nentry_feed_per_tooth_mm = {:.4f}\nair_feed_per_tooth_mm = {:.4f}\n"
        "max_feed_per_tooth_mm = {:.3f}\nhighest_programmed_feed_mm_s = {:.3f}\n",
        part.name, d, part.teeth, part.teeth, d, 2.2 * d, part.shape == "one_way" ? "up" : "down", stated_runout_um,
        tooth_force_limit_N(d), law.k_s_N_per_mm2, law.k_1, law.K_te_N_per_mm, law.K_re_N_per_mm, law.K_s_relative_sd,
        entry_mm, entry_mm, largest_feed_per_tooth_mm(part), programmed_feed_mm_min(part) / 60.0);
}

std::string box_text(std::string_view heading, const StockBox& box) {
    return fmt::format(
        "{}\nmin_x_mm = {:.3f}\nmin_y_mm = {:.3f}\nmax_x_mm = {:.3f}\nmax_y_mm = {:.3f}\ntop_mm = {:.3f}\n"
        "top_end_mm = {:.3f}\n",
        heading, box.min_x_mm, box.min_y_mm, box.max_x_mm, box.max_y_mm, box.top_start_mm, box.top_end_mm);
}

std::string stock_text(const StockSettings& stock) {
    std::string text = box_text("[stock]", stock.block);
    text += fmt::format("cell_mm = {}\nstart_x_mm = {:.3f}\nstart_y_mm = {:.3f}\nstart_z_mm = {:.3f}\n", stock.cell_mm,
                        stock.start_x_mm, stock.start_y_mm, stock.start_z_mm);
    for (const StockBox& box : stock.boxes) {
        text += box_text("\n[[stock.box]]", box);
    }
    for (const StockCylinder& hole : stock.drilled) {
        text +=
            fmt::format("\n[[stock.drilled]]\nx_mm = {:.3f}\ny_mm = {:.3f}\ndiameter_mm = {:.3f}\ntop_mm = {:.3f}\n",
                        hole.x_mm, hole.y_mm, hole.diameter_mm, hole.top_mm);
    }
    return text;
}

std::string scenario_text(const BenchPart& part, const StockSettings& stock) {
    return fmt::format(
        "# SPDX-License-Identifier: Apache-2.0\n"
        "title = \"{0}\"\ndescription = \"{1}\"\nmachine = \"vmc.toml\"\ntool = \"{0}_tool.toml\"\n"
        "program = \"{0}.ngc\"\nseed = 1\n\n{2}\n[cutter]\nrunout_um = 6\n\n"
        "[material]\nname = \"SM45C\"\nK_tc_N_mm2 = 1650\nK_rc_N_mm2 = 620\nK_ac_N_mm2 = 250\nK_te_N_mm = 22\n"
        "K_re_N_mm = 28\n",
        part.name, part.meaning, stock_text(stock));
}

/// As scenarios/slot_vfd.toml has it.
constexpr LoadMeterSettings converter_meter{0.1, 0.1, 0.05, 0.1};

}  // namespace

void write_part_files(const std::filesystem::path& folder, const BenchPart& part) {
    const PartProgram program = program_of_part(part);
    const std::string name(part.name);
    write_text_file(folder / "vmc.toml", bench_assets::vmc_machine());
    write_text_file(folder / "vfd.toml", bench_assets::vfd_machine());
    write_text_file(folder / (name + "_tool.toml"), tool_text(part));
    write_text_file(folder / (name + ".ngc"), program.gcode);
    write_text_file(folder / (name + ".toml"), scenario_text(part, program.stock));
}

Scenario read_bench_part(const std::filesystem::path& folder, const BenchPart& part, BenchMachine machine) {
    Scenario scenario = read_scenario((folder / (std::string(part.name) + ".toml")).string());
    switch (machine) {
        case BenchMachine::currents:
            break;
        case BenchMachine::spindle_alone:
            for (auto& axis : scenario.parameters.machine.axes) {
                axis.K_x4_N_per_A = 0.0F;
            }
            break;
        case BenchMachine::converter:
            scenario.parameters.machine = host::read_machine_parameters((folder / "vfd.toml").string());
            scenario.machine.encoder_counts_per_rev = scenario.parameters.machine.encoder_counts_per_rev;
            scenario.machine.load_meter = converter_meter;
            break;
    }
    return scenario;
}

}  // namespace millforce::sim
