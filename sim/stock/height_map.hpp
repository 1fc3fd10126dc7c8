#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "cutting/cutter.hpp"

namespace millforce::sim {

/// The workpiece as the height of its material over each cell of a grid in x and y: what a three-axis tool can cut has
/// no undercut. Cells are squares of `cell_mm`; a cell belongs to the tool when its centre does.
/// Memory: 4 bytes a cell, at most 64 million cells. Throws InputError where the block is empty or too large.
class HeightMap {
  public:
    /// Outside the block there is air: height `nothing_mm`.
    static constexpr float nothing_mm = -1e30F;

    HeightMap(double min_x_mm, double min_y_mm, double max_x_mm, double max_y_mm, double cell_mm, double top_mm);

    /// Sets the height within a rectangle; the top may slope from min_x to max_x. May raise (island) or lower (slot).
    void set_box(double min_x_mm, double min_y_mm, double max_x_mm, double max_y_mm, double top_at_min_x_mm,
                 double top_at_max_x_mm);
    void set_cylinder(double x_mm, double y_mm, double diameter_mm, double top_mm);

    /// Takes away what the cutter's body covers on a straight way from one tip position to another.
    /// Steps of half a cell along the way; cost about 2R/cell rows of 2R/cell cells a step.
    void remove(const Cutter& cutter, const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm);

    /// Height of the cell that holds a point.
    [[nodiscard]] float height_mm(double x_mm, double y_mm) const;

    /// How a point lies between four cells: what share of them stands above z (bilinear), and how high those stand on
    /// average. A straight wall so comes out where it is and not where its cells are.
    struct Material {
        float share = 0.0F;
        float top_mm = nothing_mm;
    };
    [[nodiscard]] Material material_above(double z_mm, double x_mm, double y_mm) const;

    [[nodiscard]] double cell_mm() const { return cell_mm_; }
    [[nodiscard]] std::size_t columns() const { return columns_; }
    [[nodiscard]] std::size_t rows() const { return rows_; }
    [[nodiscard]] std::span<const float> heights_mm() const { return heights_; }

  private:
    void stamp_flat(double x_mm, double y_mm, double radius_mm, float z_mm);
    void stamp_ball(double x_mm, double y_mm, double radius_mm, double z_mm);
    [[nodiscard]] float at(std::ptrdiff_t column, std::ptrdiff_t row) const;

    double min_x_mm_;
    double min_y_mm_;
    double cell_mm_;
    std::size_t columns_ = 0;
    std::size_t rows_ = 0;
    std::vector<float> heights_;
};

}  // namespace millforce::sim
