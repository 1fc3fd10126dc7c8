// SPDX-License-Identifier: Apache-2.0
#include "loop/machine_kind.hpp"

#include <filesystem>

#include "parameters/parameter_files.hpp"

namespace millforce::sim {

namespace {

using Table = host::TomlFile::Table;

/// The noise of every current, of the plant and as the controller is given it.
void set_noise(MachineKind& kind, double share_of_rated) {
    kind.current_noise_share = share_of_rated;
    firmware::MachineParameters<float>& machine = kind.machine;
    machine.spindle.current_sd_A = static_cast<float>(share_of_rated) * machine.spindle_rated_current_A;
    for (std::size_t k = 0; k < machine.axes.size(); ++k) {
        machine.axes[k].current_sd_A = static_cast<float>(share_of_rated) * machine.axis_rated_current_A[k];
    }
}

/// How well the gains are known. The plants of an ensemble are drawn from it.
void set_gain_deviation(firmware::MachineParameters<float>& machine, double relative_sd) {
    machine.spindle.gain_relative_sd = static_cast<float>(relative_sd);
    for (auto& axis : machine.axes) {
        axis.gain_relative_sd = static_cast<float>(relative_sd);
    }
}

void read_currents(Table& root, MachineKind& kind) {
    Table table = root.table("currents");
    constexpr CurrentChannel channels[] = {CurrentChannel::per_mille_int16, CurrentChannel::adc_12_bit};
    kind.channel = channels[table.choice("channel", {"per_mille_int16", "adc_12_bit"}, 0)];
    if (table.has("noise_share")) {
        set_noise(kind, table.number("noise_share", 0.0, 0.5));
    }
    if (table.has("gain_relative_sd")) {
        set_gain_deviation(kind.machine, table.number("gain_relative_sd", 0.0, 0.5));
    }
    if (!table.boolean("axes", true)) {
        for (auto& axis : kind.machine.axes) {
            axis.K_x4_N_per_A = 0.0F;
        }
    }
    table.reject_unknown_keys();
}

}  // namespace

MachineKind read_machine_kind(const std::string& path) {
    host::TomlFile file = host::TomlFile::open(path);
    Table root = file.root();
    MachineKind kind;
    kind.title = root.text("title");
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    kind.machine = host::read_machine_parameters((folder / root.text("machine")).string());
    float& latency_s = kind.machine.cnc.override_latency_s;
    latency_s = static_cast<float>(root.number("override_latency_s", 0.0, 1.0, static_cast<double>(latency_s)));
    kind.has_part_map = root.boolean("part_map", false);
    read_currents(root, kind);
    read_load_meter(root, kind.load_meter);
    root.reject_unknown_keys();
    return kind;
}

Scenario on_machine(Scenario scenario, const MachineKind& kind) {
    scenario.parameters.machine = kind.machine;
    scenario.machine.encoder_counts_per_rev = kind.machine.encoder_counts_per_rev;
    scenario.machine.current_channel = kind.channel;
    scenario.machine.load_meter = kind.load_meter;
    scenario.deviation.current_noise_share = kind.current_noise_share;
    return scenario;
}

void read_load_meter(Table& root, LoadMeterSettings& meter) {
    Table table = root.table("load_meter");
    meter.period_s = table.number("period_s", 0.0, 10.0, meter.period_s);
    meter.age_s = table.number("age_s", 0.0, 10.0, meter.age_s);
    meter.smoothing_s = table.number("smoothing_s", 0.0, 10.0, meter.smoothing_s);
    meter.resolution_A = table.number("resolution_A", 1e-6, 100.0, meter.resolution_A);
    table.reject_unknown_keys();
}

}  // namespace millforce::sim
