// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cutting/cutter.hpp"

namespace millforce::sim {

class SweptDisc;

/// The workpiece as the height of its material over each cell of a grid in x and y: what a three-axis tool can cut has
/// no undercut. Cells are squares of `cell_mm`.
///
/// A cell with an edge in it holds two heights and the share of its area at the lower one, to 1/255. So a wall is where
/// it was cut, and not where the cells end. As `material_above` sees it, a straight wall lies within 0.1 cells of its
/// place, and without a bias. A third height in one cell (walls of two levels less than a cell apart) is merged into
/// the lower one.
///
/// Memory: 9 bytes a cell, at most 64 million cells. Throws InputError where the block is empty, not finite or too
/// large.
class HeightMap {
  public:
    /// Outside the block there is air: height `nothing_mm`.
    static constexpr float nothing_mm = -1e30F;

    HeightMap(double min_x_mm, double min_y_mm, double max_x_mm, double max_y_mm, double cell_mm, double top_mm);

    /// Sets the height within a rectangle; the top may slope from min_x to max_x. May raise (island) or lower (slot).
    void set_box(double min_x_mm, double min_y_mm, double max_x_mm, double max_y_mm, double top_at_min_x_mm,
                 double top_at_max_x_mm);
    void set_cylinder(double x_mm, double y_mm, double diameter_mm, double top_mm);

    /// Takes away what the cutter's body covers on a straight way from one tip position to another, both included. On
    /// a slope the bottom is a staircase with steps of half a cell or 1 µm, at or below the true one. Where the way
    /// goes on from the end of the last one, only the crescent that is new is looked at, and a tool that has sunk by
    /// less than 1 µm leaves the ground that it stood on as it is. Positions that are not finite remove nothing.
    void remove(const Cutter& cutter, const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm);

    /// Height of the cell that holds a point; of the larger part, where an edge runs through.
    [[nodiscard]] float height_mm(double x_mm, double y_mm) const;

    /// How a point lies between four cells: the share of them above z (bilinear), and the mean height of those. The
    /// share is one half where a wall is.
    struct Material {
        float share = 0.0F;
        float top_mm = nothing_mm;
    };
    [[nodiscard]] Material material_above(double z_mm, double x_mm, double y_mm) const {
        // From the centre of the first cell, plus one: nothing inside the grid is negative, so that a cast rounds down.
        const double u = (x_mm - min_x_mm_) * cells_per_mm_ + 0.5;
        const double v = (y_mm - min_y_mm_) * cells_per_mm_ + 0.5;
        const auto above_mm = static_cast<float>(z_mm + height_resolution_mm);
        // Most of a block is plain: the four cells around the point have one and the same height.
        if (u >= 1.0 && v >= 1.0 && u < static_cast<double>(columns_) && v < static_cast<double>(rows_)) {
            const std::size_t index = (static_cast<std::size_t>(v) - 1) * columns_ + static_cast<std::size_t>(u) - 1;
            if (all_alike(index)) {
                const float height_mm = cells_[index].larger_part_mm;
                return height_mm > above_mm ? Material{1.0F, height_mm} : Material{};
            }
        }
        return mean_material(above_mm, u, v);
    }

    [[nodiscard]] double cell_mm() const { return cell_mm_; }
    [[nodiscard]] std::size_t columns() const { return columns_; }
    [[nodiscard]] std::size_t rows() const { return rows_; }
    /// Height of the larger part of each cell, row by row.
    [[nodiscard]] float cell_height_mm(std::size_t row, std::size_t column) const {
        return cells_[row * columns_ + column].larger_part_mm;
    }

  private:
    /// Heights of the two parts of a cell; the same where it has one height.
    struct Cell {
        float larger_part_mm;
        float smaller_part_mm;

        [[nodiscard]] float highest_mm() const { return std::max(larger_part_mm, smaller_part_mm); }
        [[nodiscard]] float lowest_mm() const { return std::min(larger_part_mm, smaller_part_mm); }
        void cut_to(float z_mm) {
            larger_part_mm = std::min(larger_part_mm, z_mm);
            smaller_part_mm = std::min(smaller_part_mm, z_mm);
        }
    };

    /// A tool that goes on and sinks by less leaves the ground as it is.
    static constexpr double height_resolution_mm = 1e-3;

    /// What a row of cells needs to know about the cutter, in cells; the height of its bottom in mm.
    struct CutterShape {
        double radius;
        bool ball;
        double z_mm;
    };

    /// Where a cutter was left: what it covers there is gone already.
    struct Standing {
        Eigen::Vector3d tip_mm;
        double radius_mm;
        bool ball;
        double floor_mm;  ///< what stands there reaches no higher
    };

    /// Whether the cell, its neighbours to the right and above, and the one between them have the same single height.
    [[nodiscard]] bool all_alike(std::size_t index) const {
        const auto both_parts = [&](std::size_t k) { return std::bit_cast<std::uint64_t>(cells_[k]); };
        const std::size_t above = index + columns_;
        const std::uint64_t here = both_parts(index);
        const std::uint64_t different =
            (both_parts(index + 1) ^ here) | (both_parts(above) ^ here) | (both_parts(above + 1) ^ here);
        return different == 0 && cells_[index].larger_part_mm == cells_[index].smaller_part_mm;
    }
    [[nodiscard]] Material mean_material(float above_mm, double u, double v) const;
    [[nodiscard]] bool goes_on(const Cutter& cutter, const Eigen::Vector3d& from_mm) const;
    void sweep(const Cutter& cutter, const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm, double z_mm,
               bool goes_on);
    void sweep_row(const SweptDisc& disc, const CutterShape& shape, double y, bool goes_on);
    void cut_edge(const SweptDisc& disc, const CutterShape& shape, std::size_t row, std::size_t column, double y);
    void set_cell(std::size_t index, float top_mm, double share);
    void cut_cell(std::size_t index, float z_mm, double share);
    void store(std::size_t index, float high_mm, float low_mm, std::uint8_t low_share);

    double min_x_mm_;
    double min_y_mm_;
    double cell_mm_;
    double cells_per_mm_;
    std::size_t columns_ = 0;
    std::size_t rows_ = 0;
    float highest_mm_;
    std::vector<Cell> cells_;
    std::vector<std::uint8_t> low_shares_;  // of 255: how much of the cell is at the lower height; 0: one height
    std::optional<Standing> standing_;
};

}  // namespace millforce::sim
