// SPDX-License-Identifier: Apache-2.0
#include "stock/height_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "files/input_error.hpp"
#include "stock/swept_disc.hpp"

namespace millforce::sim {

namespace {

constexpr double most_cells = 64e6;
constexpr double most_steps = 1e6;  // of a sloping way: more than any machine's travel
constexpr std::uint8_t whole = 255;

std::uint8_t in_steps(double share) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
}

/// Share of the cell about `centre` (of unit width) between two borders.
double overlap(double centre, double low, double high) {
    return std::clamp(std::min(centre + 0.5, high) - std::max(centre - 0.5, low), 0.0, 1.0);
}

/// The columns whose centres lie from `low` to `high`, as [first, end). Conversions cut off fractions, which costs less
/// than std::ceil: after clipping nothing is negative.
struct Columns {
    std::size_t first = 0;
    std::size_t end = 0;

    Columns(const SweptDisc::Interval& interval, std::size_t count) {
        if (interval.right >= 0.0 && interval.left <= interval.right) {
            const auto most = static_cast<double>(count);
            end = static_cast<std::size_t>(std::min(interval.right + 1.0, most));
            const double left = std::clamp(interval.left, 0.0, most);
            first = static_cast<std::size_t>(left);
            first += static_cast<double>(first) < left ? 1U : 0U;
            first = std::min(first, end);
        }
    }
};

/// Calls visit(column) for what is left of the columns without the excluded ones.
template <typename Visit>
void visit_columns(const Columns& columns, const Columns& excluded, const Visit& visit) {
    const bool none = excluded.first >= excluded.end;
    const std::size_t gap_first = none ? columns.end : std::min(columns.end, excluded.first);
    const std::size_t gap_end = none ? columns.end : std::max(columns.first, excluded.end);
    for (std::size_t column = columns.first; column < gap_first; ++column) {
        visit(column);
    }
    for (std::size_t column = gap_end; column < columns.end; ++column) {
        visit(column);
    }
}

}  // namespace

HeightMap::HeightMap(double min_x_mm, double min_y_mm, double max_x_mm, double max_y_mm, double cell_mm, double top_mm)
    : min_x_mm_(min_x_mm),
      min_y_mm_(min_y_mm),
      cell_mm_(cell_mm),
      cells_per_mm_(1.0 / cell_mm),
      highest_mm_(static_cast<float>(top_mm)) {
    const double width = (max_x_mm - min_x_mm) / cell_mm;
    const double depth = (max_y_mm - min_y_mm) / cell_mm;
    const double columns = std::ceil(width - 1e-9);
    const double rows = std::ceil(depth - 1e-9);
    if (!(columns >= 1.0 && rows >= 1.0 && columns * rows <= most_cells && cell_mm > 0.0 && std::isfinite(top_mm))) {
        throw host::InputError(
            fmt::format("stock: a block of {} × {} mm, {} mm high, in cells of {} mm has {} × {} cells, "
                        "expected 1 to 64 million in all",
                        max_x_mm - min_x_mm, max_y_mm - min_y_mm, top_mm, cell_mm, columns, rows));
    }
    columns_ = static_cast<std::size_t>(columns);
    rows_ = static_cast<std::size_t>(rows);
    cells_.assign(columns_ * rows_, Cell{highest_mm_, highest_mm_});
    low_shares_.assign(columns_ * rows_, 0);
    // A block that ends within a cell leaves the rest of the cell empty.
    const std::uint8_t empty_column = in_steps(columns - width);
    const std::uint8_t empty_row = in_steps(rows - depth);
    for (std::size_t row = 0; row < rows_ && empty_column > 0; ++row) {
        store(row * columns_ + columns_ - 1, highest_mm_, nothing_mm, empty_column);
    }
    for (std::size_t column = 0; column < columns_ && empty_row > 0; ++column) {
        store((rows_ - 1) * columns_ + column, highest_mm_, nothing_mm, empty_row);
    }
}

void HeightMap::store(std::size_t index, float high_mm, float low_mm, std::uint8_t low_share) {
    const bool one_height = low_share == 0 || low_share == whole || !(low_mm < high_mm);
    const bool mostly_low = low_share > whole / 2;
    const float larger_mm = mostly_low ? low_mm : high_mm;
    const float smaller_mm = mostly_low ? high_mm : low_mm;
    cells_[index] = {larger_mm, one_height ? larger_mm : smaller_mm};
    low_shares_[index] = one_height ? std::uint8_t{0} : low_share;
}

// The rest of the cell keeps what it had. Where as much of it was empty before as is left out now, the edges coincide.
void HeightMap::set_cell(std::size_t index, float top_mm, double share) {
    const std::uint8_t set_share = in_steps(share);
    const auto rest = static_cast<std::uint8_t>(whole - set_share);
    if (set_share == 0) {
        return;
    }
    const float low_mm = cells_[index].lowest_mm();
    const bool same_edge = low_shares_[index] > 0 && std::abs(int{low_shares_[index]} - int{rest}) <= 2;
    const float before_mm = same_edge ? low_mm : cells_[index].larger_part_mm;
    if (top_mm >= before_mm) {
        store(index, top_mm, before_mm, rest);
    } else {
        store(index, before_mm, top_mm, set_share);
    }
}

void HeightMap::set_box(double min_x_mm, double min_y_mm, double max_x_mm, double max_y_mm, double top_at_min_x_mm,
                        double top_at_max_x_mm) {
    standing_.reset();
    highest_mm_ = std::max({highest_mm_, static_cast<float>(top_at_min_x_mm), static_cast<float>(top_at_max_x_mm)});
    const double left = (min_x_mm - min_x_mm_) / cell_mm_ - 0.5;
    const double right = (max_x_mm - min_x_mm_) / cell_mm_ - 0.5;
    const double bottom = (min_y_mm - min_y_mm_) / cell_mm_ - 0.5;
    const double top = (max_y_mm - min_y_mm_) / cell_mm_ - 0.5;
    for (std::size_t row = 0; row < rows_; ++row) {
        const double row_share = overlap(static_cast<double>(row), bottom, top);
        for (std::size_t column = 0; column < columns_ && row_share > 0.0; ++column) {
            const double along = (static_cast<double>(column) - left) / std::max(right - left, 1.0);
            const double height_mm =
                top_at_min_x_mm + (top_at_max_x_mm - top_at_min_x_mm) * std::clamp(along, 0.0, 1.0);
            set_cell(row * columns_ + column, static_cast<float>(height_mm),
                     row_share * overlap(static_cast<double>(column), left, right));
        }
    }
}

void HeightMap::set_cylinder(double x_mm, double y_mm, double diameter_mm, double top_mm) {
    standing_.reset();
    highest_mm_ = std::max(highest_mm_, static_cast<float>(top_mm));
    const double x = (x_mm - min_x_mm_) / cell_mm_ - 0.5;
    const double y = (y_mm - min_y_mm_) / cell_mm_ - 0.5;
    const double radius = 0.5 * diameter_mm / cell_mm_;
    for (std::size_t row = 0; row < rows_; ++row) {
        for (std::size_t column = 0; column < columns_; ++column) {
            const double distance = std::hypot(static_cast<double>(column) - x, static_cast<double>(row) - y);
            set_cell(row * columns_ + column, static_cast<float>(top_mm), radius - distance + 0.5);
        }
    }
}

bool HeightMap::goes_on(const Cutter& cutter, const Eigen::Vector3d& from_mm) const {
    return standing_ && standing_->tip_mm == from_mm && standing_->radius_mm == 0.5 * cutter.diameter_mm &&
           standing_->ball == (cutter.type == CutterType::ball_end_mill);
}

void HeightMap::remove(const Cutter& cutter, const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm) {
    if (!from_mm.allFinite() || !to_mm.allFinite()) {
        return;
    }
    const double way_mm = (to_mm - from_mm).head<2>().norm();
    const double stairs = std::min(way_mm / (0.5 * cell_mm_), std::abs(to_mm.z() - from_mm.z()) / height_resolution_mm);
    const long steps = std::lround(std::clamp(std::ceil(stairs), 1.0, most_steps));
    Eigen::Vector3d before_mm = from_mm;
    constexpr double nowhere_mm = std::numeric_limits<double>::infinity();
    double floor_mm = goes_on(cutter, from_mm) ? standing_->floor_mm : nowhere_mm;
    for (long k = 1; k <= steps; ++k) {
        const double share = static_cast<double>(k) / static_cast<double>(steps);
        const Eigen::Vector3d tip_mm = k == steps ? to_mm : (from_mm + (to_mm - from_mm) * share).eval();
        const double z_mm = std::min(before_mm.z(), tip_mm.z());
        const bool sinks = z_mm < floor_mm - height_resolution_mm;
        sweep(cutter, before_mm, tip_mm, z_mm, !sinks);
        floor_mm = sinks ? z_mm : std::max(floor_mm, z_mm);
        before_mm = tip_mm;
    }
    standing_ = Standing{to_mm, 0.5 * cutter.diameter_mm, cutter.type == CutterType::ball_end_mill, floor_mm};
}

void HeightMap::sweep(const Cutter& cutter, const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm, double z_mm,
                      bool goes_on) {
    if (z_mm >= static_cast<double>(highest_mm_)) {
        return;
    }
    const CutterShape shape{0.5 * cutter.diameter_mm / cell_mm_, cutter.type == CutterType::ball_end_mill, z_mm};
    const auto in_cells = [&](const Eigen::Vector3d& point_mm) {
        return Eigen::Vector2d((point_mm.x() - min_x_mm_) / cell_mm_ - 0.5,
                               (point_mm.y() - min_y_mm_) / cell_mm_ - 0.5);
    };
    const SweptDisc disc(in_cells(from_mm), in_cells(to_mm));
    const double reach = shape.radius + 0.5;
    const auto row_at = [&](double y) {
        return static_cast<std::size_t>(std::clamp(y, 0.0, static_cast<double>(rows_)));
    };
    const std::size_t end = row_at(std::floor(disc.highest_y() + reach) + 1.0);
    for (std::size_t row = row_at(std::ceil(disc.lowest_y() - reach)); row < end; ++row) {
        sweep_row(disc, shape, static_cast<double>(row), goes_on);
    }
}

void HeightMap::sweep_row(const SweptDisc& disc, const CutterShape& shape, double y, bool goes_on) {
    const double outer = shape.radius + 0.5;                     // beyond it no cell is touched
    const double inner = shape.ball ? 0.0 : shape.radius - 0.5;  // within it cells are covered whole
    const std::size_t row = static_cast<std::size_t>(y) * columns_;
    const Columns touched(goes_on ? disc.ahead(y, disc.row(y, outer)) : disc.row(y, outer), columns_);
    const Columns covered(disc.row(y, inner), columns_);
    const Columns gone(goes_on ? disc.start_row(y, inner) : SweptDisc::Interval{}, columns_);
    visit_columns(touched, covered, [&](std::size_t column) { cut_edge(disc, shape, row, column, y); });
    const auto z_mm = static_cast<float>(shape.z_mm);
    visit_columns(covered, gone, [&](std::size_t column) { cells_[row + column].cut_to(z_mm); });
}

void HeightMap::cut_edge(const SweptDisc& disc, const CutterShape& shape, std::size_t row, std::size_t column,
                         double y) {
    const std::size_t index = row + column;
    if (cells_[index].highest_mm() <= static_cast<float>(shape.z_mm)) {
        return;
    }
    const double distance = disc.distance(static_cast<double>(column), y);
    double bottom_mm = shape.z_mm;
    if (shape.ball) {
        const double rim = std::min(distance, shape.radius);
        bottom_mm += (shape.radius - std::sqrt(shape.radius * shape.radius - rim * rim)) * cell_mm_;
    }
    cut_cell(index, static_cast<float>(bottom_mm), shape.radius - distance + 0.5);
}

void HeightMap::cut_cell(std::size_t index, float z_mm, double share) {
    const std::uint8_t cut = in_steps(share);
    const float high_mm = cells_[index].highest_mm();
    if (cut == 0 || z_mm >= high_mm) {
        return;
    }
    const float low_mm = cells_[index].lowest_mm();
    const std::uint8_t low_share = low_mm < high_mm ? low_shares_[index] : std::uint8_t{0};
    if (cut == whole) {
        cells_[index].cut_to(z_mm);
    } else if (low_share == 0) {
        store(index, high_mm, z_mm, cut);
    } else if (z_mm < low_mm) {
        // The low part falls as a whole, once the cutter covers most of it: so covering it again changes nothing.
        if (2 * cut >= low_share) {
            store(index, high_mm, z_mm, std::max(cut, low_share));
        }
    } else if (cut > low_share) {
        const float mean_mm = (low_mm * static_cast<float>(low_share) + z_mm * static_cast<float>(cut - low_share)) /
                              static_cast<float>(cut);
        store(index, high_mm, mean_mm, cut);
    }
}

float HeightMap::height_mm(double x_mm, double y_mm) const {
    const double column = std::floor((x_mm - min_x_mm_) / cell_mm_);
    const double row = std::floor((y_mm - min_y_mm_) / cell_mm_);
    if (!(column >= 0.0 && row >= 0.0 && column < static_cast<double>(columns_) && row < static_cast<double>(rows_))) {
        return nothing_mm;
    }
    return cell_height_mm(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
}

HeightMap::Material HeightMap::mean_material(float above_mm, double u, double v) const {
    if (!(u > 0.0 && v > 0.0 && u < static_cast<double>(columns_) + 1.0 && v < static_cast<double>(rows_) + 1.0)) {
        return {};
    }
    // Column and row right of and above the point; those before them may lie outside the grid.
    const auto column = static_cast<std::size_t>(u);
    const auto row = static_cast<std::size_t>(v);
    const auto a = static_cast<float>(u - static_cast<double>(column));
    const auto b = static_cast<float>(v - static_cast<double>(row));
    Material material;
    float sum = 0.0F;
    const auto add = [&](std::size_t k, std::size_t i, float weight) {
        if (k == 0 || i == 0 || k > rows_ || i > columns_) {
            return;
        }
        const std::size_t index = (k - 1) * columns_ + (i - 1);
        // The larger part is the low one if more than half of the cell is low.
        const float low = static_cast<float>(low_shares_[index]) * (1.0F / 255.0F);
        const float smaller = std::min(low, 1.0F - low);
        const Cell& cell = cells_[index];
        if (cell.larger_part_mm > above_mm) {
            material.share += weight * (1.0F - smaller);
            sum += weight * (1.0F - smaller) * cell.larger_part_mm;
        }
        if (smaller > 0.0F && cell.smaller_part_mm > above_mm) {
            material.share += weight * smaller;
            sum += weight * smaller * cell.smaller_part_mm;
        }
    };
    add(row, column, (1.0F - a) * (1.0F - b));
    add(row, column + 1, a * (1.0F - b));
    add(row + 1, column, (1.0F - a) * b);
    add(row + 1, column + 1, a * b);
    if (material.share > 0.0F) {
        material.top_mm = sum / material.share;
    }
    return material;
}

}  // namespace millforce::sim
