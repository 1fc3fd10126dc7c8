// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <memory>

namespace millforce::host {

/// A value at a time; NaN: none.
struct Sample {
    double time_s = 0.0;
    double value = std::numeric_limits<double>::quiet_NaN();
};

/// Turns samples into those of another quantity: each sample that comes in comes out once, in order and with its time,
/// some of them later. Times must grow.
class SampleDerivation {
  public:
    virtual ~SampleDerivation() = default;
    SampleDerivation(const SampleDerivation&) = delete;
    SampleDerivation& operator=(const SampleDerivation&) = delete;

    virtual void add(const Sample& sample, std::deque<Sample>& out) = 0;
    /// No more comes: what is still in goes out.
    virtual void finish(std::deque<Sample>& out) = 0;
    /// Time of the first sample that is still in; infinite where none is.
    [[nodiscard]] virtual double waits_since_s() const { return std::numeric_limits<double>::infinity(); }

  protected:
    SampleDerivation() = default;
};

/// A velocity out of positions: the difference over the samples within ±smoothing_s/2, as many before as after, over
/// their time. This is the central difference of the position, averaged over that time. None where there is no sample
/// on both sides, as at the ends and beside a gap, or a value is missing. Comes out smoothing_s/2 late.
class PositionSlope final : public SampleDerivation {
  public:
    explicit PositionSlope(double smoothing_s) : half_s_(0.5 * smoothing_s * (1.0 + 1e-6)) {}
    void add(const Sample& sample, std::deque<Sample>& out) override;
    void finish(std::deque<Sample>& out) override;
    [[nodiscard]] double waits_since_s() const override;

  private:
    [[nodiscard]] double slope() const;
    void give(std::deque<Sample>& out);

    double half_s_;
    std::deque<Sample> samples_;
    std::size_t next_ = 0;  ///< among samples_: the first that has not gone out
};

/// An angle out of a speed in rad/s: integrated with the trapezoidal rule from 0 on, over missing values and gaps in a
/// straight line.
class SpeedIntegral final : public SampleDerivation {
  public:
    void add(const Sample& sample, std::deque<Sample>& out) override;
    void finish(std::deque<Sample>& /*out*/) override {}

  private:
    Sample last_{};
    double angle_rad_ = 0.0;
};

/// An angle out of a pulse once per turn: a turn from one sample that is the first above the threshold to the next
/// such, at constant speed between the two. None before the first pulse, after the last one, and in a turn of more than
/// 2 s. An edge is known to one sample. Comes out a turn late, or 2 s.
class IndexAngle final : public SampleDerivation {
  public:
    static constexpr double longest_turn_s = 2.0;

    explicit IndexAngle(double threshold) : threshold_(threshold) {}
    void add(const Sample& sample, std::deque<Sample>& out) override;
    void finish(std::deque<Sample>& out) override;
    [[nodiscard]] double waits_since_s() const override;

  private:
    void end_turn(double edge_s, std::deque<Sample>& out);

    double threshold_;
    std::deque<double> waiting_s_;  ///< times of the samples that are in
    double edge_s_ = std::numeric_limits<double>::quiet_NaN();
    std::uint64_t turns_ = 0;
    bool is_high_ = true;  ///< a pulse that was there from the start has no edge
};

/// Continues a value that begins again at `wrap`: differences beyond half of it are a jump.
class Unwrap {
  public:
    explicit Unwrap(double wrap) : wrap_(wrap) {}
    /// NaN stays NaN. False where the value is more than `wrap` away from the last one.
    [[nodiscard]] bool follow(double& value);
    [[nodiscard]] double last() const { return last_; }

  private:
    double wrap_;
    double last_ = std::numeric_limits<double>::quiet_NaN();
    double whole_ = 0.0;
};

}  // namespace millforce::host
