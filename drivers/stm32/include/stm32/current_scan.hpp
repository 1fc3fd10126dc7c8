// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "stm32/registers.hpp"

/// Four currents by ADC1: a timer's TRGO starts each scan of four channels, DMA2 stream 0 writes it into a ring, take()
/// gives the means over what came since the last one. No interrupt, no heap. RM0090 13, 10

namespace millforce::stm32 {

inline constexpr std::size_t scan_channels = 4;

struct CurrentChannel {
    std::uint8_t input = 0;  ///< ADC1_IN0…18
    float A_per_V = 0.0F;    ///< rms current per volt; negative: the sensor counts against the motor; 0: not wired
    float zero_V = 1.65F;    ///< output of the sensor at 0 A
    float largest_A = 0.0F;  ///< limit; a value beyond it is not used
};

struct CurrentScanSettings {
    std::array<CurrentChannel, scan_channels> channels{};
    float reference_V = 3.3F;
};

struct ScanReading {
    std::array<bool, scan_channels> has{};
    std::array<float, scan_channels> current_A{};
    std::uint32_t scans = 0;  ///< scans in the means
};

struct CurrentScanHealth {
    std::uint32_t restarts = 0;      ///< after an overrun of the converter or an error of the DMA
    std::uint32_t at_rail = 0;       ///< values at the end of the range, not used: a broken wire is no current
    std::uint32_t beyond_limit = 0;  ///< values beyond largest_A
};

/// take() at least every `ring_scans` − 1 scans; what is older is overwritten, unseen. One thread; the ring lies in RAM
/// that the DMA reaches (not in the core-coupled one).
class CurrentScan {
  public:
    static constexpr std::size_t ring_scans = 32;

    CurrentScan(AdcRegisters& adc, AdcCommonRegisters& common, DmaRegisters& dma, const CurrentScanSettings& settings)
        : adc_(adc), common_(common), dma_(dma), settings_(settings) {}

    /// The trigger is TIM8's TRGO, to be started after this.
    void start();
    /// Absent: a channel that is not wired, or without a usable value. All are where no scan came.
    [[nodiscard]] ScanReading take();
    [[nodiscard]] const CurrentScanHealth& health() const { return health_; }

    /// For the DMA, and for a test in its place.
    using Ring = std::array<volatile std::uint16_t, ring_scans * scan_channels>;
    [[nodiscard]] Ring& ring() { return ring_; }

  private:
    void start_dma();
    void start_converter();
    [[nodiscard]] bool failed() const;
    [[nodiscard]] std::size_t scan_in_work() const;
    void add_scan(std::size_t scan, std::array<std::uint32_t, scan_channels>& sums,
                  std::array<std::uint32_t, scan_channels>& counts);
    [[nodiscard]] float volts(std::uint32_t sum, std::uint32_t count) const;

    AdcRegisters& adc_;
    AdcCommonRegisters& common_;
    DmaRegisters& dma_;
    CurrentScanSettings settings_;
    alignas(4) Ring ring_{};
    std::size_t next_scan_ = 0;
    CurrentScanHealth health_{};
};

}  // namespace millforce::stm32
