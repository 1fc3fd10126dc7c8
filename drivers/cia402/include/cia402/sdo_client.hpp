// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "cia402/rejects.hpp"
#include "hal/can_frame.hpp"

/// Expedited SDO transfers (CiA 301), client side: reads or writes one object of up to 4 bytes of one node at a time.
/// A pure state machine; frames and times come in, frames go out. Segmented answers are refused with an abort.

namespace millforce::cia402 {

struct SdoRequest {
    std::uint16_t index = 0;
    std::uint8_t subindex = 0;
    std::uint8_t bytes = 0;  ///< 1…4: write `value`; 0: read
    std::uint32_t value = 0;
};

enum class SdoState : std::uint8_t {
    idle,     ///< nothing asked
    pending,  ///< asked; left by the answer, or by poll() after the last repetition
    done,     ///< `value()` is what was read
    aborted,  ///< the node refused: `abort_code()`
    silent,   ///< no answer to the request and its repetitions
};

inline constexpr std::uint32_t abort_command_unknown = 0x05040001;

class SdoClient {
  public:
    static constexpr std::uint64_t answer_timeout_us = 100'000;
    static constexpr std::uint8_t repetitions = 2;

    explicit SdoClient(std::uint8_t node_id = 0) : node_id_(node_id) {}

    /// Forgets what was asked before.
    void ask(const SdoRequest& request, std::uint64_t time_us);
    /// A frame with the id 0x580 + node.
    void on_frame(const hal::CanFrame& frame, RejectCounters& rejects);
    void poll(std::uint64_t time_us);
    /// True once for each frame that is to be sent.
    [[nodiscard]] bool take_frame(hal::CanFrame& frame);

    [[nodiscard]] SdoState state() const { return state_; }
    [[nodiscard]] std::uint32_t value() const { return value_; }
    [[nodiscard]] std::uint32_t abort_code() const { return abort_code_; }
    void reset() { state_ = SdoState::idle; }

  private:
    [[nodiscard]] bool is_about_request(const hal::CanFrame& frame) const;
    void take_upload(const hal::CanFrame& frame, RejectCounters& rejects);

    std::uint8_t node_id_;
    SdoRequest request_{};
    SdoState state_ = SdoState::idle;
    std::uint8_t sends_left_ = 0;
    bool to_send_ = false;
    bool abort_to_send_ = false;
    std::uint64_t deadline_us_ = 0;
    std::uint32_t value_ = 0;
    std::uint32_t abort_code_ = 0;
};

}  // namespace millforce::cia402
