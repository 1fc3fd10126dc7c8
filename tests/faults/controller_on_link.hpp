// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <utility>

#include "firmware/parameters.hpp"
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

/// Messages to a controller and back. The CNC's side does as millforce_guard: without an answer for 0.1 s, or after a
/// message that ended the connection, it holds the feed, for good.
class ControllerOnLink : public sim::OverrideSource {
  public:
    /// The bytes of a message to the controller; false: it ends the connection.
    using Exchange = std::function<bool(std::span<const std::uint8_t> message, local_link::OverrideBytes& answer)>;

    ControllerOnLink(Exchange exchange, std::uint64_t seed) : exchange_(std::move(exchange)), random_(seed) {}

    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override;
    void describe(sim::TracePoint&) const override {}  // the controller keeps its estimates
    void begin(LinkFault fault) { fault_ = fault; }
    /// The fault is over; where the guard holds, a new connection is made to `exchange`.
    void repair(Exchange exchange);
    void press_reset(bool pressed) { resets_ = pressed; }

  private:
    [[nodiscard]] bool is_answered(const local_link::SampleMessage& message);
    [[nodiscard]] bool is_by_chance(double share) { return std::bernoulli_distribution(share)(random_); }

    Exchange exchange_;
    std::mt19937_64 random_;
    LinkFault fault_ = LinkFault::none;
    local_link::SampleMessage message_{};
    local_link::OverrideMessage answer_{};
    std::uint32_t answered_us_ = 0;
    std::uint32_t sequence_ = 0;
    bool is_guarded_ = false;  ///< the guard holds
    bool resets_ = false;
};

/// A LinkController in this process.
[[nodiscard]] ControllerOnLink::Exchange link_controller(const firmware::Parameters<float>& parameters);

}  // namespace millforce::faults
