// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

#include "estimation/surface/roughness.hpp"
#include "files/csv.hpp"
#include "firmware/tick_record.hpp"

/// The table of estimates that a replay writes, whatever it reads.

namespace millforce::host {

inline constexpr std::string_view estimate_header =
    "time_s,state,tangential_force_N,feed_force_N,radial_immersion,radial_immersion_sd,axial_depth_mm,"
    "axial_depth_sd_mm,peak_force_N,force_limit_N,override";

void write_estimate_row(std::ostream& out, double time_s, const firmware::TickRecord& tick,
                        const firmware::ShownForces& shown);

/// The column `tool`, where the tools come from a folder: the number of the tool that the override is for, empty where
/// it is not known.
class ToolCells {
  public:
    explicit ToolCells(bool are_there) : are_there_(are_there) {}

    void write_header(std::ostream& out) const { out << (are_there_ ? ",tool" : ""); }
    void write(std::ostream& out, std::uint32_t tool) {
        if (are_there_) {
            out << ',' << (tool != 0 ? std::to_string(tool) : "");
            ++rows_;
            without_ += tool == 0 ? 1U : 0U;
        }
    }
    /// Empty where the tool was known throughout.
    [[nodiscard]] std::string note() const {
        return without_ > 0
                   ? fmt::format("the tool is not known in {} of {} rows: the override is the operator's there",
                                 without_, rows_)
                   : std::string();
    }

  private:
    bool are_there_;
    std::size_t rows_ = 0;
    std::size_t without_ = 0;
};

/// The last columns: by how much the chip of one tooth is thicker than the mean one, at most; the side of the cut, how
/// badly the law explains the forces, and what holds the override down.
class ReasonCells {
  public:
    static void write_header(std::ostream& out) { out << ",runout_um,cut_side,law_misfit,limit,fault"; }
    static void write(std::ostream& out, const firmware::TickRecord& tick);
};

/// The columns of the roughness, where the tool has a model of it: value, 95 % interval, and 1 within the range of the
/// model's tests or 0 outside.
class RoughnessCells {
  public:
    explicit RoughnessCells(const estimation::RoughnessModel<float>& model)
        : is_there_(model.constant_um > 0.0F), name_(model.measure == estimation::RoughnessMeasure::Ra ? "Ra" : "Rz") {}

    void write_header(std::ostream& out) const {
        out << (is_there_ ? fmt::format(",{0}_um,{0}_low_um,{0}_high_um,{0}_in_range", name_) : std::string());
    }
    void write(std::ostream& out, const estimation::RoughnessPrediction<float>& roughness) {
        if (!is_there_) {
            return;
        }
        const auto cell = [](bool is_known, float value) { return is_known ? CsvWriter::cell(value) : std::string(); };
        out << ',' << cell(roughness.valid, roughness.roughness_um) << ','
            << cell(roughness.has_interval, roughness.low_um) << ',' << cell(roughness.has_interval, roughness.high_um)
            << ',' << (roughness.valid ? (roughness.in_range() ? "1" : "0") : "");
        predicted_ += roughness.valid ? 1U : 0U;
        outside_ += roughness.valid && !roughness.in_range() ? 1U : 0U;
    }
    [[nodiscard]] std::string summary() const {
        return is_there_ ? fmt::format("{}: {} rows with a prediction, {} of them outside the fitted range\n", name_,
                                       predicted_, outside_)
                         : std::string();
    }

  private:
    bool is_there_;
    std::string name_;
    std::size_t predicted_ = 0;
    std::size_t outside_ = 0;
};

}  // namespace millforce::host
