// SPDX-License-Identifier: Apache-2.0
#include "faults/campaign.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string_view>

#include "firmware/can/controller_on_loopback.hpp"
#include "loop/bounds.hpp"
#include "loop/ensemble.hpp"
#include "loop/simulation.hpp"
#include "sim/converter_load.hpp"
#include "sim/without_axis_currents.hpp"

namespace millforce::faults {

namespace {

/// Four times as fast as the plant's usual resolution; the force errs by at most (0.1 rad)²/6, 0.2 %.
constexpr sim::EdgeResolution coarse{.largest_angle_per_slice_rad = 0.1, .largest_turn_rad = 0.11};

/// A controller on its path, and how a fault of that path begins.
struct Seat {
    std::unique_ptr<sim::OverrideSource> controller;
    OnPath on_path{};
};

Seat seat_on_bus(const sim::Scenario& scenario, const Fault& fault, std::uint64_t seed) {
    auto controller = std::make_unique<test::ControllerOnLoopback>(scenario);
    controller->keeps_log = false;
    controller->ticks.is_kept = false;
    Seat seat;
    if (const auto* of_bus = std::get_if<BusFault>(&fault)) {
        seat.on_path.begin = [bus = controller.get(), kind = *of_bus, seed] {
            bus->wire.set_fault(on_bus(kind, seed));
        };
    }
    seat.on_path.repair = [bus = controller.get()] { bus->wire.set_fault({}); };
    seat.on_path.reset = [bus = controller.get()](bool pressed) { bus->cnc.press_reset(pressed); };
    seat.controller = std::move(controller);
    return seat;
}

Seat seat_on_link(const sim::Scenario& scenario, const Fault& fault, std::uint64_t seed) {
    auto controller = std::make_unique<ControllerOnLink>(link_controller(scenario.parameters), seed);
    Seat seat;
    if (const auto* of_link = std::get_if<LinkFault>(&fault)) {
        seat.on_path.begin = [link = controller.get(), kind = *of_link] { link->begin(kind); };
    }
    seat.on_path.repair = [link = controller.get(), parameters = scenario.parameters] {
        link->repair(link_controller(parameters));
    };
    seat.on_path.reset = [link = controller.get()](bool pressed) { link->press_reset(pressed); };
    seat.controller = std::move(controller);
    return seat;
}

Seat seat_at_tick(const sim::Scenario& scenario) {
    auto controller = std::make_unique<sim::MillforceController>(scenario.parameters);
    Seat seat;
    seat.on_path.repair = [] {};
    seat.on_path.reset = [tick = controller.get()](bool pressed) {
        if (pressed) {
            tick->reset_fault();
        }
    };
    seat.controller = std::move(controller);
    return seat;
}

Seat seat_on(Path path, const Part& part, const Fault& fault, std::uint64_t seed) {
    sim::Scenario stated = part.scenario;
    stated.parameters = part.stated;
    switch (path) {
        case Path::can:
            return seat_on_bus(stated, fault, seed);
        case Path::link:
            return seat_on_link(stated, fault, seed);
        case Path::tick:
            break;
    }
    return seat_at_tick(stated);
}

FaultyMachine::Corrupt corruption(const Part& part, const Fault& fault, std::uint64_t seed) {
    const auto* of_signal = std::get_if<SignalFault>(&fault);
    if (of_signal == nullptr || *of_signal == SignalFault::none) {
        return {};
    }
    const firmware::MachineParameters<float>& machine = part.stated.machine;
    const Rated rated{static_cast<double>(machine.spindle_rated_current_A),
                      static_cast<double>(machine.axis_rated_current_A[0]), machine.encoder_counts_per_rev};
    return [corruption = SignalCorruption(*of_signal, rated, seed)](
               hal::DriveSample& sample, hal::ProgramStatus& program, const hal::DriveSample& before,
               double since_s) mutable { corruption.corrupt(sample, program, before, since_s); };
}

bool is_in_message_alone(SignalFault fault) {
    switch (fault) {
        case SignalFault::not_a_number:
        case SignalFault::spindle_absent:
        case SignalFault::encoder_absent:
        case SignalFault::feed_not_a_number:
        case SignalFault::operator_not_a_number:
        case SignalFault::time_frozen:
        case SignalFault::time_backwards:
        case SignalFault::time_double:
        case SignalFault::time_half:
        case SignalFault::time_jitters:
        case SignalFault::all_late:
            return true;
        default:
            return false;
    }
}

bool is_of_axes(SignalFault fault) {
    return fault >= SignalFault::x_tenfold && fault <= SignalFault::x_and_y_swapped;
}

template <typename Kind>
void append(std::vector<Fault>& faults, int first, int end) {
    for (int k = first; k < end; ++k) {
        faults.emplace_back(static_cast<Kind>(k));
    }
}

}  // namespace

const char* name_of(Path path) {
    constexpr const char* names[] = {"tick", "can", "link"};
    static_assert(std::size(names) == paths);
    return names[static_cast<std::size_t>(path)];
}

const char* name_of(const Fault& fault) {
    return std::visit([](auto kind) { return name_of(kind); }, fault);
}

bool leaves_blind(const Fault& fault, const Part& part) {
    using S = SignalFault;
    if (part.is_load_seldom && fault == Fault{S::spindle_frozen}) {
        return false;
    }
    static constexpr std::array<Fault, 14> blind{S::spindle_frozen,
                                                 S::spindle_dead,
                                                 S::spindle_absent,
                                                 S::encoder_frozen,
                                                 S::encoder_absent,
                                                 S::not_a_number,
                                                 S::time_frozen,
                                                 S::time_backwards,
                                                 BusFault::spindle_silent,
                                                 BusFault::override_lost,
                                                 BusFault::bus_dead,
                                                 LinkFault::nothing_present,
                                                 LinkFault::samples_repeated,
                                                 LinkFault::controller_hangs};
    return std::find(blind.begin(), blind.end(), fault) != blind.end();
}

bool is_unseen(const Fault& fault, const Part& part) {
    using S = SignalFault;
    static constexpr std::array<Fault, 5> like_another_cut{S::spindle_drifts, S::x_drifts, S::spindle_fair,
                                                           S::spindle_fades, S::currents_halved};
    const bool is_like_another_cut =
        std::find(like_another_cut.begin(), like_another_cut.end(), fault) != like_another_cut.end();
    return fault == Fault{S::status_frozen} || fault == Fault{S::x_strong} ||
           (is_like_another_cut && (part.is_declared || part.is_spindle_alone));
}

namespace {

void set_undeclared(Part& part) {
    part.is_declared = false;
    part.scenario.parameters.tool.declared_axial_depth_mm = 0.0F;
    part.scenario.parameters.tool.control.depth_step_ratio =
        control::FeedControllerParameters<float>{}.depth_step_ratio;
}

/// What is known of the cut beside encoder and CNC.
void set_machine(Part& part, std::string_view machine) {
    constexpr double load_period_s = 0.1;
    constexpr double load_age_s = 0.1;
    part.is_spindle_alone = !machine.empty();
    part.is_load_seldom = machine == ":vfd";
    if (part.is_load_seldom) {
        part.scenario = test::with_converter_load(part.scenario, load_period_s, load_age_s);
    }
    part.stated =
        part.is_spindle_alone ? test::without_axis_currents(part.scenario.parameters) : part.scenario.parameters;
}

}  // namespace

Part part_named(const std::string& name) {
    constexpr std::string_view undeclared = ":undeclared";
    const std::size_t colon = std::min(name.find(':'), name.size());
    std::string_view machine = std::string_view(name).substr(colon);
    Part part;
    part.name = name;
    part.scenario =
        sim::read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/" + name.substr(0, colon) + ".toml");
    if (machine.starts_with(undeclared)) {
        set_undeclared(part);
        machine.remove_prefix(undeclared.size());
    }
    set_machine(part, machine);
    part.scenario.cutting_options.resolution = coarse;
    sim::MillforceController controller(part.stated);
    part.duration_s = sim::simulate(part.scenario, controller, "millforce").result.figures.time_s;
    return part;
}

std::vector<Fault> faults_on(Path path, const Part& part) {
    std::vector<Fault> faults;
    append<SignalFault>(faults, 0, signal_faults);
    std::erase_if(faults, [&](const Fault& fault) {
        const auto kind = std::get<SignalFault>(fault);
        return (path == Path::can && is_in_message_alone(kind)) || (part.is_spindle_alone && is_of_axes(kind));
    });
    if (path == Path::can) {
        append<BusFault>(faults, 0, bus_faults);
    } else if (path == Path::link) {
        append<LinkFault>(faults, 1, link_faults);
    }
    return faults;
}

namespace {

/// Over the limit. `begins_s`, `held_s`: in the time of the trace.
double peak_between(const sim::RunResult& run, double begins_s, double held_s) {
    constexpr double braking_s = 0.1;
    double peak_N = 0.0;
    for (const sim::TracePoint& point : run.trace) {
        const bool is_between = point.time_s >= begins_s && point.time_s <= held_s + braking_s;
        peak_N = is_between ? std::max(peak_N, point.true_tooth_force_N) : peak_N;
    }
    return peak_N > 0.0 ? peak_N / run.figures.peak_tooth_force_N * run.figures.peak_over_limit : 0.0;
}

}  // namespace

Outcome mill_with_controller(const Part& part, sim::OverrideSource& controller, const Fault& fault, std::uint64_t seed,
                             const OnPath& on_path) {
    constexpr double spindle_start_s = 2.0;  // of a simulation, before the program begins
    std::mt19937_64 random(seed);
    sim::Scenario scenario = part.scenario;
    scenario.seed = seed;
    scenario.deviation = sim::drawn_deviation(scenario, seed);
    const bool is_sound = fault == Fault{SignalFault::none};  // is judged from its begin
    const double into_part_s = is_sound ? 0.0 : std::uniform_real_distribution(0.0, part.duration_s)(random);
    FaultyMachine machine(controller, {.begins_s = spindle_start_s + into_part_s,
                                       .override_max = static_cast<double>(part.stated.machine.cnc.override_max),
                                       .on_path = on_path,
                                       .corrupt = corruption(part, fault, seed),
                                       .leaves_blind = leaves_blind(fault, part)});
    sim::SimulationSettings stopped_early;
    const double of_repair_s = on_path.repair ? part.duration_s : 0.0;
    stopped_early.longest_run_s = 1.5 * part.duration_s + of_repair_s;
    stopped_early.progress = [&machine](double) { return !machine.is_over(); };
    Outcome outcome;
    outcome.run = sim::simulate(scenario, machine, "millforce", stopped_early).result;
    outcome.reaction = machine.reaction();
    if (outcome.reaction.has_reacted) {
        outcome.peak_until_held = peak_between(outcome.run, into_part_s, into_part_s + outcome.reaction.after_s);
    }
    outcome.crawled = !outcome.run.figures.finished && !(outcome.reaction.held_s > 0.0) && outcome.reaction.fault == 0;
    return outcome;
}

namespace {

/// Currents as noisy as drives have them, 0.3 to 3 % of the rated one, and as the machine's file then states.
Part with_drawn_noise(const Part& part, std::uint64_t seed) {
    std::seed_seq mixed{seed, std::uint64_t{0x4e01}};
    std::mt19937_64 random(mixed);
    const double share = 0.003 * std::pow(10.0, std::uniform_real_distribution<double>()(random));
    Part drawn = part;
    drawn.scenario.deviation.current_noise_share = share;
    auto& machine = drawn.stated.machine;
    const auto noise_A = static_cast<float>(share) * machine.spindle_rated_current_A;
    machine.spindle.current_sd_A = part.is_load_seldom ? machine.spindle.current_sd_A : noise_A;
    for (std::size_t k = 0; k < machine.axes.size(); ++k) {
        machine.axes[k].current_sd_A = static_cast<float>(share) * machine.axis_rated_current_A[k];
    }
    return drawn;
}

}  // namespace

Outcome mill_with(const Part& part, Path path, const Fault& fault, std::uint64_t seed, bool is_repaired) {
    const Part drawn = with_drawn_noise(part, seed);
    Seat seat = seat_on(path, drawn, fault, seed);
    if (!is_repaired) {
        seat.on_path.repair = {};
    }
    return mill_with_controller(drawn, *seat.controller, fault, seed, seat.on_path);
}

void Tally::add(const Outcome& outcome, bool is_unseen) {
    if (!outcome.reaction.has_begun) {
        return;
    }
    const int violations_before = violations();
    ++runs;
    const sim::RunFigures& figures = outcome.run.figures;
    broken_parts += figures.teeth_broken > 0 ? 1 : 0;
    over += figures.peak_over_limit > sim::largest_peak_over_limit ? 1 : 0;
    beyond_bound += outcome.reaction.is_beyond_bound ? 1 : 0;
    ran_in_fault += outcome.reaction.ran_in_fault ? 1 : 0;
    rose_blind += outcome.reaction.rose_blind ? 1 : 0;
    stopped_silently += outcome.reaction.stopped_silently ? 1 : 0;
    crawled += outcome.crawled ? 1 : 0;
    repaired += outcome.reaction.is_repaired ? 1 : 0;
    milled_on += outcome.reaction.is_repaired && figures.finished ? 1 : 0;
    largest_peak_until_held = std::max(largest_peak_until_held, outcome.peak_until_held);
    largest_peak = std::max(largest_peak, figures.peak_over_limit);
    if (outcome.reaction.has_reacted) {
        reactions_s.push_back(outcome.reaction.after_s);
    }
    if (is_unseen) {
        ++unseen_runs;
        unseen_violations += violations() - violations_before;
    }
}

}  // namespace millforce::faults
