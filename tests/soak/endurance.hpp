// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "control/cut_state.hpp"
#include "hal/feed_override.hpp"
#include "soak/repeated_part.hpp"

/// One controller that mills the same part for hours, and what came out of it. `Mill`: begin_hour(hour), step(sample,
/// program) and answer().

namespace millforce::soak {

/// What a controller says after a sample; an estimate that it has not got is 0.
struct Answer {
    hal::FeedOverride output{};
    std::array<float, 3> estimates{};  ///< immersion, depth in mm, force on one tooth in N

    [[nodiscard]] bool is_same_as(const Answer& other) const {
        return output.ratio == other.output.ratio && output.hold == other.output.hold &&
               output.state == other.output.state && output.fault == other.output.fault && estimates == other.estimates;
    }
};

struct Endured {
    std::uint64_t samples = 0;
    std::uint64_t faults = 0;           ///< samples with a fault or a hold
    std::uint64_t wrong_heartbeat = 0;  ///< samples whose heartbeat is not the last one's plus one
    std::uint64_t with_immersion = 0;
    std::uint64_t compared = 0;
    std::uint64_t different = 0;  ///< of those, answers that are not the first hour's, bit for bit
    float largest_override_difference = 0.0F;
    float override_difference_of_last_hour = 0.0F;
    std::array<float, 2> override_range{10.0F, 0.0F};
};

template <typename Mill>
class Endurance {
  public:
    Endurance(Mill& mill, const RepeatedPart& part) : mill_(mill), part_(part) { first_.reserve(part.size()); }

    /// Of each hour, the last part is compared with the first hour's last.
    void run_hour(std::uint64_t hour) {
        const auto parts_per_hour = static_cast<std::uint64_t>(std::lround(3600.0 / part_.duration_s()));
        mill_.begin_hour(hour);
        endured_.override_difference_of_last_hour = 0.0F;
        for (std::uint64_t k = 0; k < parts_per_hour; ++k) {
            mill_part(hour * parts_per_hour + k, k + 1 == parts_per_hour, hour == 0);
        }
    }

    [[nodiscard]] const Endured& endured() const { return endured_; }

  private:
    void mill_part(std::uint64_t number, bool is_last_of_hour, bool is_first_hour) {
        for (std::size_t i = 0; i < part_.size(); ++i) {
            mill_.step(part_.sample(number, i), part_.program(i));
            const Answer answer = mill_.answer();
            note(answer);
            if (is_last_of_hour && is_first_hour) {
                first_.push_back(answer);
            } else if (is_last_of_hour) {
                compare(answer, first_[i]);
            }
        }
    }

    void note(const Answer& answer) {
        ++endured_.samples;
        endured_.faults += answer.output.fault != 0 || answer.output.hold ? 1U : 0U;
        endured_.wrong_heartbeat += answer.output.heartbeat == heartbeat_ + 1 ? 0U : 1U;
        heartbeat_ = answer.output.heartbeat;
        endured_.with_immersion += answer.estimates[0] > 0.0F ? 1U : 0U;
        if (answer.output.state == static_cast<std::uint8_t>(control::CutState::in_cut)) {
            auto& [low, high] = endured_.override_range;
            low = std::min(low, answer.output.ratio);
            high = std::max(high, answer.output.ratio);
        }
    }

    void compare(const Answer& answer, const Answer& first) {
        ++endured_.compared;
        endured_.different += answer.is_same_as(first) ? 0U : 1U;
        const float difference = std::fabs(answer.output.ratio - first.output.ratio);
        for (float* const largest :
             {&endured_.largest_override_difference, &endured_.override_difference_of_last_hour}) {
            *largest = std::max(*largest, difference);
        }
    }

    Mill& mill_;
    const RepeatedPart& part_;
    std::vector<Answer> first_;
    Endured endured_;
    std::uint32_t heartbeat_ = 0;
};

}  // namespace millforce::soak
