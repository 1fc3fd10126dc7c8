// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cia402/drive_settings.hpp"
#include "cia402/pdo_mapping.hpp"

/// Which mapped object carries which quantity, and the last raw value of each.

namespace millforce::cia402 {

enum class Signal : std::uint8_t { statusword, current, torque, velocity, position, count, index_count, index_number };
inline constexpr std::size_t signal_count = static_cast<std::size_t>(Signal::index_number) + 1;

/// An object may carry several signals (position is the axis position and the default count); where two PDOs carry the
/// same object the first one counts.
class SignalTable {
  public:
    SignalTable() = default;
    explicit SignalTable(const DriveSettings& settings);

    /// Stores what a frame of the right length carries.
    void take(std::size_t pdo, const std::array<std::uint8_t, hal::largest_can_length>& data);

    [[nodiscard]] bool is_mapped(Signal signal) const { return place(signal).bits != 0; }
    [[nodiscard]] std::size_t pdo(Signal signal) const { return place(signal).pdo; }
    [[nodiscard]] std::uint8_t bits(Signal signal) const { return place(signal).bits; }
    [[nodiscard]] std::uint32_t raw(Signal signal) const { return raw_[static_cast<std::size_t>(signal)]; }
    [[nodiscard]] std::int32_t signed_value(Signal signal) const { return sign_extended(raw(signal), bits(signal)); }

  private:
    struct Place {
        std::uint8_t pdo = 0;
        std::uint8_t first_bit = 0;
        std::uint8_t bits = 0;  ///< 0: not mapped
    };
    [[nodiscard]] const Place& place(Signal signal) const { return places_[static_cast<std::size_t>(signal)]; }
    void place_object(const DriveSettings& settings, const MappedObject& object, Place where);

    std::array<Place, signal_count> places_{};
    std::array<std::uint32_t, signal_count> raw_{};
};

}  // namespace millforce::cia402
