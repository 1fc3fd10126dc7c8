// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "iio/attribute.hpp"
#include "iio/scan_format.hpp"

namespace millforce::iio {

inline constexpr std::size_t scan_element_capacity = 16;
inline constexpr std::size_t largest_scan_bytes = 256;
inline constexpr std::string_view timestamp_name = "timestamp";

using ChannelName = std::array<char, 24>;  ///< `voltage0`, zero-terminated; empty: none
[[nodiscard]] std::string_view view(const ChannelName& name);
/// False where the name is empty, too long or no name of a file.
bool set(ChannelName& name, std::string_view text);

struct ScanElement {
    ChannelName name{};
    std::uint32_t index = 0;
    std::uint32_t first_byte = 0;
    ScanFormat format{};
};

/// Where each enabled element of a device lies in a scan: ordered by index, each aligned to its own size, the whole to
/// the largest (as the kernel's iio_compute_scan_bytes).
class ScanLayout {
  public:
    /// Reads the folder scan_elements. With `wanted`, first switches these and the timestamp on and all others off.
    [[nodiscard]] Fault read(const Path& device, std::span<const ChannelName> wanted, bool configures);

    [[nodiscard]] const ScanElement* find(std::string_view name) const;
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    [[nodiscard]] std::span<const ScanElement> elements() const { return std::span(elements_).first(count_); }

  private:
    [[nodiscard]] Fault take_element(const Path& folder, const ChannelName& name);
    [[nodiscard]] IioError arrange();

    std::array<ScanElement, scan_element_capacity> elements_{};
    std::size_t count_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace millforce::iio
