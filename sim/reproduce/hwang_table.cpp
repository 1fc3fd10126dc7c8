// SPDX-License-Identifier: Apache-2.0
#include "reproduce/hwang_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace millforce::sim {

std::vector<TableRow> table_rows() {
    const BenchMaterial steel = steel_SM45C();
    const auto row = [&](const char* group, double rpm, double diameter_mm, double feed_mm, int inserts,
                         double depth_mm) {
        return TableRow{group,
                        {.spindle_speed_rpm = rpm,
                         .diameter_mm = diameter_mm,
                         .feed_per_tooth_mm = feed_mm,
                         .teeth = inserts,
                         .axial_depth_mm = depth_mm,
                         .material = steel}};
    };
    std::vector<TableRow> rows{
        row("spindle speed", 200, 100, 0.15, 3, 1.5), row("spindle speed", 300, 100, 0.15, 3, 1.5),
        row("spindle speed", 400, 100, 0.15, 3, 1.5), row("depth of cut", 300, 100, 0.15, 3, 1.0),
        row("depth of cut", 300, 100, 0.15, 3, 1.5),  row("depth of cut", 300, 100, 0.15, 3, 2.0),
        row("diameter", 300, 50, 0.15, 3, 1.5),       row("diameter", 300, 100, 0.15, 3, 1.5),
        row("inserts", 200, 100, 0.15, 2, 1.0),       row("inserts", 200, 100, 0.15, 3, 1.0),
        row("inserts", 200, 100, 0.15, 6, 1.0),       row("feed", 300, 100, 0.10, 3, 1.5),
        row("feed", 300, 100, 0.15, 3, 1.5),          row("feed", 300, 100, 0.20, 3, 1.5),
        row("material", 300, 100, 0.15, 3, 1.5),      row("material", 300, 100, 0.15, 3, 1.5),
    };
    rows.back().cut.material = aluminium_6061();
    return rows;
}

std::string describe(const BenchCut& cut) {
    return fmt::format("{:.0f} rpm, Ø{:.0f}, {} inserts, {:.2f} mm/tooth, {:.1f} mm deep, {}", cut.spindle_speed_rpm,
                       cut.diameter_mm, cut.teeth, cut.feed_per_tooth_mm, cut.axial_depth_mm, cut.material.name);
}

int TableCut::estimates() const {
    return static_cast<int>(
        std::count_if(runs.begin(), runs.end(), [](const ForceDropRun& run) { return run.estimate.valid(); }));
}

double TableCut::mean() const {
    double sum = 0.0;
    for (const ForceDropRun& run : runs) {
        sum += run.estimate.valid() ? static_cast<double>(run.estimate.radial_immersion) : 0.0;
    }
    return estimates() > 0 ? sum / estimates() : no_estimate;
}

double TableCut::largest_relative_error() const {
    double largest = estimates() > 0 ? 0.0 : no_estimate;
    for (const ForceDropRun& run : runs) {
        if (run.estimate.valid()) {
            const double error = std::abs(static_cast<double>(run.estimate.radial_immersion) / run.immersion - 1.0);
            largest = std::max(largest, error);
        }
    }
    return largest;
}

bool is_steel(const TableRow& row) {
    return row.cut.material.name == steel_SM45C().name;
}

double relative_error(double ours, double truth) {
    return std::abs(ours / truth - 1.0);
}

double mean_error(const std::vector<TableResult>& results, double immersion) {
    double sum = 0.0;
    int count = 0;
    for (const TableResult& row : results) {
        for (const TableCut& cut : row) {
            if (cut.estimates() > 0 && (immersion == 0.0 || cut.immersion == immersion)) {
                sum += relative_error(cut.mean(), cut.immersion);
                ++count;
            }
        }
    }
    return count > 0 ? sum / count : no_estimate;
}

void ForceDropTally::add(const ForceDropRun& run) {
    ++runs;
    if (!run.estimate.valid()) {
        return;
    }
    ++estimates;
    const double ours = static_cast<double>(run.estimate.radial_immersion);
    const double sd = static_cast<double>(run.estimate.radial_immersion_sd);
    covered += std::abs(ours - run.immersion) <= 2.0 * sd ? 1 : 0;
    error_sum += relative_error(ours, run.immersion);
    largest_error = std::max(largest_error, relative_error(ours, run.immersion));
}

double ForceDropTally::share() const {
    return runs > 0 ? static_cast<double>(estimates) / runs : 0.0;
}

double ForceDropTally::coverage() const {
    return estimates > 0 ? static_cast<double>(covered) / estimates : no_estimate;
}

double ForceDropTally::mean_error() const {
    return estimates > 0 ? error_sum / estimates : no_estimate;
}

double ForceDropTally::largest() const {
    return estimates > 0 ? largest_error : no_estimate;
}

ForceDropTally tally_of(const std::vector<TableResult>& results) {
    ForceDropTally tally;
    for (const TableResult& row : results) {
        for (const TableCut& cut : row) {
            std::for_each(cut.runs.begin(), cut.runs.end(), [&](const ForceDropRun& run) { tally.add(run); });
        }
    }
    return tally;
}

TableResult mill_row(const FittedForceDropLaw& law, const TableRow& row, std::uint64_t seed) {
    TableResult result;
    std::uint64_t number = 0;
    for (const double immersion : table_immersions) {
        BenchCut cut = row.cut;
        cut.immersion = immersion;
        cut.runout_angle_rad = 6.0 * std::fmod(0.37 * static_cast<double>(seed * 7U + number), 1.0);
        const auto samples =
            bench_samples(cut, {.seed = seed * 100U + number}, revolutions_per_estimate * estimates_per_cut + 0.1);
        result.push_back({immersion, run_force_drop(law, cut, revolutions_per_estimate, samples)});
        ++number;
    }
    return result;
}

}  // namespace millforce::sim
