// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/axis_motion.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>
#include <vector>

namespace millforce::host {

/// Collects stretches of steady velocity, without their beginning (the drive settles) and their end (it begins to
/// brake): read_steady_feeds() sample by sample. Memory: 50 ms of samples.
class SteadyFeedFinder {
  public:
    explicit SteadyFeedFinder(double minimum_speed_mm_s) : minimum_speed_mm_s_(minimum_speed_mm_s) {}

    void add(double time_s, double velocity_mm_s, double current_A) {
        const double tolerance = std::max(0.03 * std::abs(mean_velocity_), 0.3);
        if (samples_ == 0 || std::abs(velocity_mm_s - mean_velocity_) > tolerance) {
            close();
            start_s_ = time_s;
        }
        ++samples_;
        mean_velocity_ += (velocity_mm_s - mean_velocity_) / static_cast<double>(samples_);
        if (time_s - start_s_ >= settling_s) {
            pending_.push_back({time_s, velocity_mm_s, current_A});
        }
        while (!pending_.empty() && time_s - pending_.front().time_s >= braking_s) {
            settle(pending_.front());
            pending_.pop_front();
        }
    }

    std::vector<SteadyFeed> finish() {
        close();
        return std::move(found_);
    }

    /// What is complete so far.
    [[nodiscard]] const std::vector<SteadyFeed>& found() const { return found_; }

    /// Ends the stretch: the next sample begins another one.
    void close() {
        constexpr double m_per_min = 0.06;  // in 1 mm/s
        const double duration = last_settled_s_ - first_settled_s_;
        if (settled_ > 2 && duration >= shortest_s && std::abs(settled_velocity_) > minimum_speed_mm_s_) {
            found_.push_back({settled_velocity_ * m_per_min, settled_current_, duration,
                              0.5 * (first_settled_s_ + last_settled_s_)});
        }
        pending_.clear();
        samples_ = settled_ = 0;
        mean_velocity_ = settled_velocity_ = settled_current_ = 0.0;
    }

  private:
    static constexpr double settling_s = 0.1;
    static constexpr double braking_s = 0.05;
    static constexpr double shortest_s = 0.2;

    struct Pending {
        double time_s;
        double velocity_mm_s;
        double current_A;
    };

    void settle(const Pending& sample) {
        first_settled_s_ = settled_ == 0 ? sample.time_s : first_settled_s_;
        last_settled_s_ = sample.time_s;
        ++settled_;
        settled_velocity_ += (sample.velocity_mm_s - settled_velocity_) / static_cast<double>(settled_);
        settled_current_ += (sample.current_A - settled_current_) / static_cast<double>(settled_);
    }

    double minimum_speed_mm_s_;
    std::vector<SteadyFeed> found_;
    std::deque<Pending> pending_;
    long samples_ = 0;
    long settled_ = 0;
    double start_s_ = 0.0;
    double first_settled_s_ = 0.0;
    double last_settled_s_ = 0.0;
    double mean_velocity_ = 0.0;
    double settled_velocity_ = 0.0;
    double settled_current_ = 0.0;
};

}  // namespace millforce::host
