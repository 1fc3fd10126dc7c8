// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "program_status/number_frame.hpp"

/// The speed that the CNC tells the spindle's drive, with the operator's share in it, as it reports it on CAN: the
/// number of number_frame.hpp, in 0.001/min; 0: not known, or the spindle is off. TPDO 4 of the node whose TPDO 1 is
/// the program status, so its id is greater by 0x300. Every 100 ms. The controller compares it with the encoder
/// (firmware/commanded_speed.hpp); a CNC that does not send it loses nothing else.

namespace millforce::program_status {

inline constexpr float speed_rad_s_per_bit = 0.001F * 6.2831853F / 60.0F;

/// The frame's id beside that of the program status; 0: the two do not fit, or there is no program status.
[[nodiscard]] constexpr std::uint32_t speed_frame_id(std::uint32_t program_status_id) {
    return id_of_pdo(4, program_status_id);
}

/// A speed that is negative, not finite or beyond 4 million/min goes out as "not known". `id` has 11 bits.
[[nodiscard]] hal::CanFrame encode_speed(float speed_rad_s, std::uint32_t id);

/// The controller's side. One thread.
class SpeedReceiver {
  public:
    /// `id` 0: there is no such frame on the bus.
    explicit SpeedReceiver(std::uint32_t id) : number_(id) {}

    /// True if the frame is valid.
    bool on_frame(const hal::CanFrame& frame, std::uint64_t time_us) { return number_.on_frame(frame, time_us); }
    /// 0: not known.
    [[nodiscard]] float speed_rad_s(std::uint64_t now_us) const {
        return static_cast<float>(number_.number(now_us)) * speed_rad_s_per_bit;
    }

  private:
    NumberReceiver number_;
};

}  // namespace millforce::program_status
