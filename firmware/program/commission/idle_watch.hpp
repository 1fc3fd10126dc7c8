// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "commission/revolution_blocks.hpp"
#include "commission/samples.hpp"

namespace millforce::host {

/// The spindle turning at one speed in air, the axes at rest.
struct IdlePlateau {
    double spindle_rad_s = 0.0;
    double current_A = 0.0;
    double noise_A = 0.0;  ///< of one sample
    double duration_s = 0.0;
    long blocks = 0;
};

/// I_idle = offset_A + slope ω, ω in rad/s.
struct IdleFit {
    double offset_A = 0.0;
    double offset_se = 0.0;
    double slope_A_s = 0.0;
    double slope_se = 0.0;
    double residual_A = 0.0;
    double noise_A = 0.0;  ///< of one sample
};

/// Idling at several speeds: what turns the spindle without a cut.
class IdleWatch final : public StepWatch {
  public:
    /// Speeds that differ by more than 5 %, each for `dwell_s`.
    IdleWatch(std::uint32_t counts_per_rev, std::size_t speeds, double dwell_s);

    void add(const TimedSample& timed) override;
    void end() override;
    [[nodiscard]] bool is_enough() const override;
    [[nodiscard]] std::string lacks() const override;

    /// Long enough ones, one for each speed.
    [[nodiscard]] std::vector<IdlePlateau> plateaus() const;
    /// Nothing with fewer than three speeds: two leave no residual.
    [[nodiscard]] std::optional<IdleFit> fit() const;

  private:
    void take_block(const RevolutionBlock& block);
    void end_plateau();

    RevolutionBlocks blocks_;
    std::size_t speeds_;
    double dwell_s_;
    IdlePlateau now_{};
    std::vector<IdlePlateau> found_;
};

}  // namespace millforce::host
