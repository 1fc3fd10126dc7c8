// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "firmware_link/link_controller.hpp"
#include "local_link/messages.hpp"
#include "loop/override_source.hpp"

/// A controller behind the local link, and what goes wrong on the way to it.

namespace millforce::faults {

enum class LinkFault : std::uint8_t {
    none,
    nothing_present,   ///< the bridge has no reading of any drive
    samples_dropped,   ///< 30 %: the bridge's queue was full
    samples_repeated,  ///< the same sample again and again
    message_altered,   ///< in 1 % of the messages one byte
    message_cut,       ///< 1 % of the messages are too short
    controller_hangs,  ///< no answer any more
};
inline constexpr int link_faults = static_cast<int>(LinkFault::controller_hangs) + 1;

const char* name_of(LinkFault fault);

/// Messages to the controller and back, without the socket. The CNC's side does as millforce_guard: without an answer
/// for 0.1 s, or after a message that ended the connection, it holds the feed, for good.
class ControllerOnLink : public sim::OverrideSource {
  public:
    ControllerOnLink(const firmware::Parameters<float>& parameters, std::uint64_t seed)
        : controller_(parameters, parameters.machine.cnc.override_max), random_(seed) {}

    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override;
    void describe(sim::TracePoint& point) const override;
    void begin(LinkFault fault) { fault_ = fault; }

  private:
    [[nodiscard]] bool is_answered(const local_link::SampleMessage& message);
    [[nodiscard]] bool is_by_chance(double share) { return std::bernoulli_distribution(share)(random_); }

    firmware::LinkController controller_;
    std::mt19937_64 random_;
    LinkFault fault_ = LinkFault::none;
    local_link::SampleMessage message_{};
    local_link::OverrideMessage answer_{};
    std::uint32_t answered_us_ = 0;
    std::uint32_t sequence_ = 0;
    bool is_guarded_ = false;  ///< the guard holds
};

}  // namespace millforce::faults
