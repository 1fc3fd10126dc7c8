// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "bus/plant_on_can.hpp"
#include "bus/plant_wiring.hpp"
#include "commands/command_line.hpp"
#include "commands/map_options.hpp"
#include "commands/plant_commands.hpp"
#include "commands/scenario_info.hpp"
#include "daemon/service.hpp"
#include "files/console.hpp"
#include "files/input_error.hpp"
#include "files/overwriting.hpp"
#include "files/progress.hpp"
#include "files/results_folder.hpp"
#include "loop/bounds.hpp"
#include "loop/recorder.hpp"
#include "loop/simulation.hpp"
#include "parameters/parameter_notes.hpp"
#include "part_map/part_map_file.hpp"
#include "preview/clairvoyant.hpp"
#include "preview/preview.hpp"
#include "recording/recording.hpp"
#include "remote/socket_controller.hpp"
#include "report/report.hpp"
#include "report/summary.hpp"

namespace millforce::sim {

namespace {

struct SimulateOptions {
    std::string scenario;
    std::string controller = "millforce";
    double controller_timeout_s = 10.0;
    std::optional<std::uint64_t> seed;
    std::string out = "out";
    bool record = false;
    bool preview = false;
    std::string map;
    std::string learn;
    double stock_tolerance_mm = host::MapLearner::default_stock_tolerance_mm;
    std::optional<double> cutting_force_scale;
    std::optional<double> friction_scale;
    std::optional<double> current_noise_share;
    double hardest = hardest_material;
    Interpreter interpreter = Interpreter::automatic;
    std::string interface;
    host::BusPace pace{};
};

constexpr const char* baseline = constant_feed;
constexpr std::string_view at_socket = "socket:";

Scenario scenario_of(const SimulateOptions& options) {
    Scenario scenario = read_scenario(options.scenario);
    scenario.interpreter = options.interpreter;
    host::show_parameter_notes(scenario.parameters);
    for (const std::string& note : program_of(scenario).notes) {
        host::print_line(stderr, "millforce: note: " + note);
    }
    scenario.seed = options.seed.value_or(scenario.seed);
    PlantDeviation& deviation = scenario.deviation;
    deviation.cutting_force_scale = options.cutting_force_scale.value_or(deviation.cutting_force_scale);
    deviation.friction_scale = options.friction_scale.value_or(deviation.friction_scale);
    deviation.current_noise_share = options.current_noise_share.value_or(deviation.current_noise_share);
    return scenario;
}

SimulationSettings settings_with(host::Progress& progress) {
    SimulationSettings settings;
    settings.progress = [&progress](double share) {
        progress.update(share);
        return true;
    };
    return settings;
}

/// Runs the scenario; with a name for it, every step at the controller's border goes into a recording.
RunResult run(const Scenario& scenario, const std::string& name, OverrideSource& controller,
              const std::optional<std::filesystem::path>& recording) {
    host::Progress progress(fmt::format("simulating {}", name), 1);
    if (!recording) {
        return simulate(scenario, controller, name, settings_with(progress)).result;
    }
    host::RecordingWriter writer(*recording, scenario.machine.encoder_counts_per_rev,
                                 scenario.machine.force_sensor.is_there());
    Recorder recorder(controller, [&](const host::RecordedStep& step) { writer.add(step); });
    Simulated simulated = simulate(scenario, recorder, name, settings_with(progress));
    writer.commit();
    return std::move(simulated.result);
}

std::optional<host::PartMap> map_of(const SimulateOptions& options, const Scenario& scenario) {
    if (!options.preview && options.map.empty()) {
        return std::nullopt;
    }
    if (options.preview) {
        return preview(scenario);
    }
    host::PartMapFile file = host::read_part_map(options.map);
    host::require_same_origin(options.map, file.origin,
                              host::origin_of(scenario.program_file, "", scenario.parameters.tool));
    return std::move(file.map);
}

/// The project's own tick, with a part map, or with one that it leaves behind.
RunResult run_with_map(const SimulateOptions& options, const Scenario& scenario,
                       const std::optional<std::filesystem::path>& recording) {
    std::optional<host::MapLearner> learner;
    if (!options.learn.empty()) {
        learner.emplace(scenario.parameters);
        learner->set_stock_tolerance(options.stock_tolerance_mm);
    }
    MappedController controller(scenario.parameters, map_of(options, scenario), learner ? &*learner : nullptr);
    RunResult result = run(scenario, "millforce", controller, recording);
    if (controller.is_refuted()) {
        host::print_line(stderr, "millforce: note: the part map did not fit this cut: the run went on without it");
    }
    if (learner) {
        const std::string tool = std::filesystem::path(scenario.tool_file).stem().string();
        const host::PartMap map = learner->map();
        host::write_part_map(options.learn,
                             {host::origin_of(scenario.program_file, tool, scenario.parameters.tool), map});
        host::print_line(stderr, fmt::format("millforce: {}: {}", options.learn, host::about_memory(map)));
    }
    return result;
}

double constant_override_of(const Scenario& scenario, double hardest) {
    host::Progress progress(hardest > 1.0 ? "finding the constant feed that is safe everywhere"
                                          : "finding the best constant feed in hindsight",
                            1);
    return safe_constant_override(scenario, hardest, settings_with(progress));
}

void print_broken_bound(const RunFigures& figures) {
    fmt::print(stderr,
               "millforce: the bound does not hold: peak {:.1f} % of the tooth's limit (at most {:.0f} %), "
               "{:.3f} s of it later than the reaction time after the engagement grew (none), {} teeth broken, {}\n",
               100.0 * figures.peak_over_limit, 100.0 * largest_peak_over_limit, figures.late_over_limit_s,
               figures.teeth_broken,
               figures.finished ? "program finished" : "program not finished: fault " + figures.fault);
}

/// The controller is another process, behind the bus.
std::unique_ptr<OverrideSource> controller_behind(const std::string& interface, const host::BusPace& pace,
                                                  const Scenario& scenario) {
    PlantOnCanSettings settings = plant_on_bus(scenario, interface);
    socketcan::CanSocketSettings socket;
    if (!socket.set_interface(interface)) {
        throw host::InputError(
            fmt::format("--bus: '{}', expected a CAN interface of at most 15 characters, e.g. vcan0", interface));
    }
    settings.time.slowness = pace.slow_motion;
    settings.time.in_lock_step = pace.lock_step;
    return std::make_unique<PlantOnCan>(settings, std::make_unique<host::SocketPort>(socket));
}

/// What is left to gain: the feed of one who knows the true force everywhere.
void print_plan(const Scenario& scenario, const RunFigures& figures) {
    const RunFigures plan = clairvoyant_run(scenario).figures;
    fmt::print(
        "\nThe plan of one who knows the true force everywhere takes {:.1f} s (peak {:.0f} % of the limit): this run "
        "takes {:.2f} times as long.\n",
        plan.time_s, 100.0 * plan.peak_over_limit, figures.time_s / plan.time_s);
}

/// The controller is another process, behind a Unix socket.
RunResult run_with_socket(const SimulateOptions& options, const Scenario& scenario,
                          const std::optional<std::filesystem::path>& recording) {
    SocketController controller(scenario, options.controller.substr(at_socket.size()),
                                LineSocket::Patience(options.controller_timeout_s));
    RunResult result = run(scenario, controller.name(), controller, recording);
    controller.end(result.figures);
    return result;
}

int simulate_scenario(const SimulateOptions& options) {
    const Scenario scenario = scenario_of(options);
    host::refuse_overwriting(options.learn,
                             {options.scenario, scenario.machine_file, scenario.tool_file, scenario.program_file});
    const std::filesystem::path out = host::results_folder(options.out, "summary.json");
    const auto recording = options.record ? std::optional(out / "recording.csv") : std::nullopt;
    const bool is_baseline = options.controller == baseline;
    std::vector<RunResult> results;
    if (!options.interface.empty()) {
        const auto controller = controller_behind(options.interface, options.pace, scenario);
        if (!options.pace.lock_step) {
            host::become_real_time();  // without permission samples are lost, and the controller counts them
        }
        results.push_back(run(scenario, "millforce", *controller, recording));
        host::leave_real_time();
    } else if (options.preview || !options.map.empty() || !options.learn.empty()) {
        results.push_back(run_with_map(options, scenario, recording));
    } else if (options.controller.starts_with(at_socket)) {
        results.push_back(run_with_socket(options, scenario, recording));
    } else if (!is_baseline) {
        results.push_back(run(scenario, options.controller,
                              *controller_named(options.controller, scenario.parameters, 0.0), recording));
    }
    ConstantFeeds feeds;
    if (options.interface.empty()) {
        feeds.hardest = options.hardest;
        feeds.safe_ratio = constant_override_of(scenario, options.hardest);
        results.push_back(run(scenario, baseline, *controller_named(baseline, scenario.parameters, feeds.safe_ratio),
                              is_baseline ? recording : std::nullopt));
    }
    if (options.interface.empty() && !is_baseline && options.hardest > 1.0) {
        feeds.hindsight_ratio = constant_override_of(scenario, 1.0);
        results.push_back(run(scenario, constant_feed_in_hindsight,
                              *controller_named(baseline, scenario.parameters, feeds.hindsight_ratio), std::nullopt));
    }
    const ScenarioInfo info = info_of(scenario, feeds);
    fmt::print("{}", summary_table(info, results));
    if (options.preview || !options.map.empty()) {
        print_plan(scenario, results.front().figures);
    }
    write_report(out, info, results);
    fmt::print("\nreport: {}\n", (out / "report.html").string());
    const RunFigures& figures = results.front().figures;
    if (!bounds_hold(figures)) {
        print_broken_bound(figures);
        return 1;
    }
    return 0;
}

}  // namespace

void add_simulate(host::Command& program) {
    auto options = std::make_shared<SimulateOptions>();
    host::Command command = program.subcommand(
        "simulate", "Mill a scenario in closed loop on the simulated machine: summary table, traces, report");
    command.footer(
        "Compared with two constant feeds: the largest with which no tooth exceeds its limit even if the material is\n"
        "harder (--hardest), and in hindsight the largest for exactly this material.\n"
        "socket:PATH is a controller in another process, in any language, that listens at a Unix socket: a line of "
        "JSON\n"
        "for each sample, a line back (sim/python/README.md).\n"
        "Exit code 1: a tooth broke, the peak went beyond 110 % of the tooth's limit or above the limit later than "
        "the\n"
        "reaction time after the engagement grew, or the program did not finish.");
    command.option("scenario", options->scenario, "Scenario to mill").required().value_name("SCENARIO.toml");
    host::Option controller = command.option("--controller", options->controller, "Controller that sets the override")
                                  .one_of_or(controller_names(), std::string(at_socket), "socket:PATH")
                                  .shows_default();
    command
        .option("--controller-timeout", options->controller_timeout_s,
                "With socket:PATH: longest wait in s for the controller to listen, and for each of its answers")
        .within(0.01, 3600.0)
        .shows_default();
    command.option("--seed", options->seed, "Seed of all noise; default: the scenario's").within(0.0, 4294967295.0);
    command.option("--out", options->out, "Folder for summary.json, trace.csv and report.html")
        .value_name("DIR")
        .shows_default();
    host::Option record =
        command.flag("--record", options->record, "Also write recording.csv, one row per drive sample, for replay");
    host::Option preview = command.flag(
        "--preview", options->preview, "Let the controller see what lies ahead: a part map of program, stock and tool");
    preview.excludes(controller).excludes(record);
    command.option("--map", options->map, "Part map made by 'millforce preview' or --learn, possibly for another stock")
        .value_name("PART.map")
        .excludes(controller)
        .excludes(record)
        .excludes(preview);
    host::Option learn = command.option(
        "--learn", options->learn, "Write the part map that this run leaves behind: what was estimated along its path");
    learn.value_name("PART.map").excludes(controller);
    host::add_stock_tolerance(command, learn, options->stock_tolerance_mm);
    command.option("--cutting-force-scale", options->cutting_force_scale, "True K_s relative to the scenario's")
        .within(0.1, 10.0);
    command.option("--friction-scale", options->friction_scale, "True friction relative to the machine file's")
        .within(0.0, 10.0);
    command
        .option("--current-noise", options->current_noise_share, "Noise of a current sample relative to rated current")
        .within(0.0, 0.5);
    command
        .option("--hardest", options->hardest,
                "Margin of the baseline: K_s of the hardest material relative to the scenario's; 1: best in hindsight")
        .within(1.0, 10.0)
        .shows_default();
    command.choice<Interpreter>(
        "--interpreter", options->interpreter,
        "Reader of the part program: own, LinuxCNC's rs274, or auto (own, then rs274)",
        {{"auto", Interpreter::automatic}, {"own", Interpreter::own}, {"rs274", Interpreter::rs274}});
    command
        .option("--bus", options->interface,
                "Put drives and CNC on this CAN interface, in real time, for 'millforce run' as another process")
        .value_name("IFACE")
        .excludes(controller);
    host::add_bus_pace(command, options->pace);
    command.on_run([options] { return simulate_scenario(*options); });
}

}  // namespace millforce::sim
