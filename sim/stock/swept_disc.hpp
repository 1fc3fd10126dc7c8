// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace millforce::sim {

/// A disc swept along a straight way, cut by rows of a grid. All lengths in cells, cell centres at whole numbers.
class SweptDisc {
  public:
    struct Interval {
        double left = std::numeric_limits<double>::infinity();
        double right = -std::numeric_limits<double>::infinity();

        [[nodiscard]] bool empty() const { return left > right; }
        void include(double low, double high) {
            left = std::min(left, low);
            right = std::max(right, high);
        }
    };

    SweptDisc(const Eigen::Vector2d& from, const Eigen::Vector2d& to)
        : from_(from), to_(to), length_((to - from).norm()) {
        if (length_ > 0.0) {
            direction_ = (to - from) / length_;
        }
    }

    /// Where a row at height y meets the disc at the way's start.
    [[nodiscard]] Interval start_row(double y, double radius) const {
        Interval row;
        include_disc(row, from_, y, radius);
        return row;
    }

    /// Where a row at height y meets the swept area: the discs at both ends and the sides of the way between.
    [[nodiscard]] Interval row(double y, double radius) const {
        Interval row;
        include_disc(row, from_, y, radius);
        include_disc(row, to_, y, radius);
        const double rise = to_.y() - from_.y();
        if (radius > 0.0 && rise != 0.0) {
            for (const double side : {-radius, radius}) {
                const double share = (y - from_.y() - side * direction_.x()) / rise;
                if (share >= 0.0 && share <= 1.0) {
                    const double x = from_.x() - side * direction_.y() + share * (to_.x() - from_.x());
                    row.include(x, x);
                }
            }
        }
        return row;
    }

    /// The part of a row ahead of the start, in the direction of the way: behind, nothing comes nearer.
    [[nodiscard]] Interval ahead(double y, Interval row) const {
        const double across = (y - from_.y()) * direction_.y();
        if (std::abs(direction_.x()) < 1e-12) {
            return across > 0.0 ? row : Interval{};
        }
        const double border = from_.x() - across / direction_.x();
        if (direction_.x() > 0.0) {
            row.left = std::max(row.left, border);
        } else {
            row.right = std::min(row.right, border);
        }
        return row;
    }

    /// Least distance of a point from the disc's centre on its way.
    [[nodiscard]] double distance(double x, double y) const {
        const Eigen::Vector2d point(x - from_.x(), y - from_.y());
        const double along = std::clamp(point.dot(direction_), 0.0, length_);
        return (point - along * direction_).norm();
    }

    [[nodiscard]] double lowest_y() const { return std::min(from_.y(), to_.y()); }
    [[nodiscard]] double highest_y() const { return std::max(from_.y(), to_.y()); }

  private:
    static void include_disc(Interval& row, const Eigen::Vector2d& centre, double y, double radius) {
        const double half_squared = radius * radius - (y - centre.y()) * (y - centre.y());
        if (radius > 0.0 && half_squared >= 0.0) {
            const double half = std::sqrt(half_squared);
            row.include(centre.x() - half, centre.x() + half);
        }
    }

    Eigen::Vector2d from_;
    Eigen::Vector2d to_;
    double length_;
    Eigen::Vector2d direction_ = Eigen::Vector2d::Zero();
};

}  // namespace millforce::sim
