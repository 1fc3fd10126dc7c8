// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calibration/steady_feed_finder.hpp"
#include "commission/samples.hpp"

namespace millforce::host {

/// Steady feeds of each axis in air, in both directions: what the friction takes.
class AirWatch final : public StepWatch {
  public:
    /// `axes`: 0 x, 1 y, 2 z. `feeds_m_per_min`: those of the program, in each direction.
    AirWatch(std::vector<std::size_t> axes, std::vector<double> feeds_m_per_min);

    void add(const TimedSample& timed) override;
    void end() override;
    [[nodiscard]] bool is_enough() const override { return lacks().empty(); }
    [[nodiscard]] std::string lacks() const override;

    [[nodiscard]] const std::vector<SteadyFeed>& found(std::size_t axis) const { return finders_.at(axis).found(); }
    /// Noise of one sample of the axis' current while it feeds; nothing where it did not.
    [[nodiscard]] std::optional<double> current_noise_A(std::size_t axis) const;

  private:
    struct Noise {
        double squared_steps = 0.0;
        long steps = 0;
        std::optional<double> last_A{};
    };
    void add_axis(std::size_t axis, const TimedSample& timed);
    void add_noise(Noise& noise, bool feeds, double current_A);
    void show_fit(std::size_t axis);
    [[nodiscard]] std::vector<double> missing(std::size_t axis) const;

    std::vector<std::size_t> axes_;
    std::vector<double> feeds_m_per_min_;
    std::array<SteadyFeedFinder, 3> finders_;
    std::array<Noise, 3> noise_{};
};

}  // namespace millforce::host
