// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace millforce::host {

/// Times of a recording: rate, how even it is, and gaps. Memory does not grow with the rows.
class StepStatistics {
  public:
    /// Times must grow.
    void add(double time_s);
    /// Call it after the last row, before all below.
    void finish();

    [[nodiscard]] std::uint64_t rows() const { return rows_; }
    [[nodiscard]] double duration_s() const { return rows_ > 0 ? last_s_ - first_s_ : 0.0; }
    /// Mean over the steps that are no gap; NaN for fewer than two rows.
    [[nodiscard]] double rate_hz() const;
    /// Standard deviation of these steps, as a share of their mean.
    [[nodiscard]] double unevenness() const;
    /// Steps longer than 1.5 times the median of the first 255.
    [[nodiscard]] std::uint64_t gaps() const { return gaps_; }
    [[nodiscard]] double longest_gap_s() const { return longest_gap_s_; }
    [[nodiscard]] double longest_gap_at_s() const { return longest_gap_at_s_; }

  private:
    struct Step {
        double length_s;
        double begin_s;
    };
    void settle_median();
    void judge(const Step& step);

    std::vector<Step> first_steps_;
    double median_s_ = std::numeric_limits<double>::quiet_NaN();
    std::uint64_t rows_ = 0;
    std::uint64_t regular_steps_ = 0;
    double sum_s_ = 0.0;  ///< sum of the steps' differences from the median
    double sum_s2_ = 0.0;
    double first_s_ = 0.0;
    double last_s_ = 0.0;
    std::uint64_t gaps_ = 0;
    double longest_gap_s_ = 0.0;
    double longest_gap_at_s_ = 0.0;
};

/// A curve as one line of text, of 24 to 48 characters: the mean of each piece of the time, between the smallest and
/// the largest mean. Memory does not grow with the samples.
class Sparkline {
  public:
    /// Times must not fall, from 0 on. NaN: none.
    void add(double time_s, double value);
    [[nodiscard]] std::string text() const;

  private:
    static constexpr std::size_t width = 48;
    struct Piece {
        double sum = 0.0;
        std::uint64_t count = 0;
    };
    void double_pieces();

    std::array<Piece, width> pieces_{};
    double piece_s_ = 1e-6;
    std::size_t used_ = 0;
};

/// What a column holds.
class ColumnStatistics {
  public:
    void add(double time_s, double value);

    [[nodiscard]] std::uint64_t count() const { return count_; }
    [[nodiscard]] std::uint64_t missing() const { return missing_; }
    /// NaN without a value, as below.
    [[nodiscard]] double minimum() const { return minimum_; }
    [[nodiscard]] double maximum() const { return maximum_; }
    [[nodiscard]] double mean() const;
    [[nodiscard]] double largest_magnitude() const;
    /// Last value minus first one.
    [[nodiscard]] double change() const { return last_ - first_; }
    /// How often a value is less than the one before, and by how much at most.
    [[nodiscard]] std::uint64_t falls() const { return falls_; }
    [[nodiscard]] double largest_fall() const { return largest_fall_; }
    [[nodiscard]] std::string sparkline() const { return sparkline_.text(); }

  private:
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    std::uint64_t count_ = 0;
    std::uint64_t missing_ = 0;
    double minimum_ = none;
    double maximum_ = none;
    double mean_ = 0.0;
    double first_ = none;
    double last_ = none;
    std::uint64_t falls_ = 0;
    double largest_fall_ = 0.0;
    Sparkline sparkline_;
};

}  // namespace millforce::host
