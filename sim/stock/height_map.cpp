#include "stock/height_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/input_error.hpp"

namespace millforce::sim {

namespace {

constexpr double most_cells = 64e6;

}  // namespace

HeightMap::HeightMap(double min_x_mm, double min_y_mm, double max_x_mm, double max_y_mm, double cell_mm, double top_mm)
    : min_x_mm_(min_x_mm), min_y_mm_(min_y_mm), cell_mm_(cell_mm) {
    const double columns = std::ceil((max_x_mm - min_x_mm) / cell_mm - 1e-9);
    const double rows = std::ceil((max_y_mm - min_y_mm) / cell_mm - 1e-9);
    if (!(columns >= 1.0 && rows >= 1.0 && columns * rows <= most_cells)) {
        throw InputError(fmt::format("stock: a block of {} × {} mm in cells of {} mm has {} × {} cells, expected 1 to "
                                     "64 million in all",
                                     max_x_mm - min_x_mm, max_y_mm - min_y_mm, cell_mm, columns, rows));
    }
    columns_ = static_cast<std::size_t>(columns);
    rows_ = static_cast<std::size_t>(rows);
    heights_.assign(columns_ * rows_, static_cast<float>(top_mm));
}

void HeightMap::set_box(double min_x_mm, double min_y_mm, double max_x_mm, double max_y_mm, double top_at_min_x_mm,
                        double top_at_max_x_mm) {
    for (std::size_t row = 0; row < rows_; ++row) {
        const double y = min_y_mm_ + (static_cast<double>(row) + 0.5) * cell_mm_;
        for (std::size_t column = 0; column < columns_ && y >= min_y_mm && y <= max_y_mm; ++column) {
            const double x = min_x_mm_ + (static_cast<double>(column) + 0.5) * cell_mm_;
            if (x >= min_x_mm && x <= max_x_mm) {
                const double share = (x - min_x_mm) / std::max(max_x_mm - min_x_mm, cell_mm_);
                heights_[row * columns_ + column] =
                    static_cast<float>(top_at_min_x_mm + (top_at_max_x_mm - top_at_min_x_mm) * share);
            }
        }
    }
}

void HeightMap::set_cylinder(double x_mm, double y_mm, double diameter_mm, double top_mm) {
    for (std::size_t row = 0; row < rows_; ++row) {
        const double dy = min_y_mm_ + (static_cast<double>(row) + 0.5) * cell_mm_ - y_mm;
        for (std::size_t column = 0; column < columns_; ++column) {
            const double dx = min_x_mm_ + (static_cast<double>(column) + 0.5) * cell_mm_ - x_mm;
            if (dx * dx + dy * dy <= 0.25 * diameter_mm * diameter_mm) {
                heights_[row * columns_ + column] = static_cast<float>(top_mm);
            }
        }
    }
}

void HeightMap::remove(const Cutter& cutter, const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm) {
    const double radius = 0.5 * cutter.diameter_mm;
    const double length = (to_mm - from_mm).norm();
    const int steps = std::max(1, static_cast<int>(std::ceil(length / (0.5 * cell_mm_))));
    for (int k = 1; k <= steps; ++k) {
        const Eigen::Vector3d tip = from_mm + (to_mm - from_mm) * (static_cast<double>(k) / steps);
        if (cutter.type == CutterType::ball_end_mill) {
            stamp_ball(tip.x(), tip.y(), radius, tip.z());
        } else {
            stamp_flat(tip.x(), tip.y(), radius, static_cast<float>(tip.z()));
        }
    }
}

void HeightMap::stamp_flat(double x_mm, double y_mm, double radius_mm, float z_mm) {
    const double centre_row = (y_mm - min_y_mm_) / cell_mm_ - 0.5;
    const double centre_column = (x_mm - min_x_mm_) / cell_mm_ - 0.5;
    const double radius_cells = radius_mm / cell_mm_;
    const double last_row = static_cast<double>(rows_) - 1.0;
    const double last_column = static_cast<double>(columns_) - 1.0;
    const double first = std::max(0.0, std::ceil(centre_row - radius_cells));
    const double last = std::min(last_row, std::floor(centre_row + radius_cells));
    for (double row = first; row <= last; row += 1.0) {
        const double half = std::sqrt(std::max(0.0, radius_cells * radius_cells - (row - centre_row) * (row - centre_row)));
        const double left = std::max(0.0, std::ceil(centre_column - half));
        const double right = std::min(last_column, std::floor(centre_column + half));
        if (left > right) {
            continue;
        }
        float* cell = heights_.data() + static_cast<std::size_t>(row) * columns_;
        const auto end = static_cast<std::size_t>(right) + 1;
        for (auto column = static_cast<std::size_t>(left); column < end; ++column) {
            cell[column] = std::min(cell[column], z_mm);
        }
    }
}

void HeightMap::stamp_ball(double x_mm, double y_mm, double radius_mm, double z_mm) {
    const auto reach = static_cast<std::ptrdiff_t>(std::ceil(radius_mm / cell_mm_));
    const auto middle_row = static_cast<std::ptrdiff_t>(std::floor((y_mm - min_y_mm_) / cell_mm_));
    const auto middle_column = static_cast<std::ptrdiff_t>(std::floor((x_mm - min_x_mm_) / cell_mm_));
    for (std::ptrdiff_t row = std::max<std::ptrdiff_t>(0, middle_row - reach);
         row <= std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(rows_) - 1, middle_row + reach); ++row) {
        const double dy = min_y_mm_ + (static_cast<double>(row) + 0.5) * cell_mm_ - y_mm;
        for (std::ptrdiff_t column = std::max<std::ptrdiff_t>(0, middle_column - reach);
             column <= std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(columns_) - 1, middle_column + reach);
             ++column) {
            const double dx = min_x_mm_ + (static_cast<double>(column) + 0.5) * cell_mm_ - x_mm;
            const double inside = radius_mm * radius_mm - dx * dx - dy * dy;
            if (inside > 0.0) {
                float& cell = heights_[static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)];
                cell = std::min(cell, static_cast<float>(z_mm + radius_mm - std::sqrt(inside)));
            }
        }
    }
}

float HeightMap::at(std::ptrdiff_t column, std::ptrdiff_t row) const {
    if (column < 0 || row < 0 || column >= static_cast<std::ptrdiff_t>(columns_) ||
        row >= static_cast<std::ptrdiff_t>(rows_)) {
        return nothing_mm;
    }
    return heights_[static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)];
}

float HeightMap::height_mm(double x_mm, double y_mm) const {
    return at(static_cast<std::ptrdiff_t>(std::floor((x_mm - min_x_mm_) / cell_mm_)),
              static_cast<std::ptrdiff_t>(std::floor((y_mm - min_y_mm_) / cell_mm_)));
}

HeightMap::Material HeightMap::material_above(double z_mm, double x_mm, double y_mm) const {
    const double u = (x_mm - min_x_mm_) / cell_mm_ - 0.5;
    const double v = (y_mm - min_y_mm_) / cell_mm_ - 0.5;
    const double column = std::floor(u);
    const double row = std::floor(v);
    const auto a = static_cast<float>(u - column);
    const auto b = static_cast<float>(v - row);
    const auto i = static_cast<std::ptrdiff_t>(column);
    const auto k = static_cast<std::ptrdiff_t>(row);
    const float heights[4] = {at(i, k), at(i + 1, k), at(i, k + 1), at(i + 1, k + 1)};
    const float weights[4] = {(1.0F - a) * (1.0F - b), a * (1.0F - b), (1.0F - a) * b, a * b};
    Material material;
    float sum = 0.0F;
    for (std::size_t n = 0; n < 4; ++n) {
        if (heights[n] > static_cast<float>(z_mm) + 1e-4F) {
            material.share += weights[n];
            sum += weights[n] * heights[n];
        }
    }
    if (material.share > 0.0F) {
        material.top_mm = sum / material.share;
    }
    return material;
}

}  // namespace millforce::sim
