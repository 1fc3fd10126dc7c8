// SPDX-License-Identifier: Apache-2.0
#include "program_status/speed_frame.hpp"

namespace millforce::program_status {

hal::CanFrame encode_speed(float speed_rad_s, std::uint32_t id) {
    constexpr float largest = 4.0e9F;
    constexpr float half = 0.5F;
    const float steps = speed_rad_s / speed_rad_s_per_bit + half;
    return encode_number(steps > half && steps < largest ? static_cast<std::uint32_t>(steps) : 0U, id);
}

}  // namespace millforce::program_status
