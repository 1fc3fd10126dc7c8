// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "iio/attribute.hpp"
#include "iio/sample_join.hpp"
#include "iio/scan_layout.hpp"

/// Motor currents from an analogue-to-digital converter through Linux IIO, for drives without a bus: the analogue
/// current monitor of a drive, or a Hall sensor. Two ways:
///
/// | | buffered | polled |
/// |---|---|---|
/// | values | every one, from /dev/iio:device0; the device samples by its trigger | one per poll(), in_voltage0_raw |
/// | time | the timestamp channel, where it is on; else when it was fetched | when it was read |
/// | overrun | gaps between timestamps | – |
///
///     V = (raw + offset) · scale,    A = (V − zero_V) · A_per_V
///
/// offset and scale from the device's files, in mV as IIO has it (Documentation/ABI/testing/sysfs-bus-iio). A value at
/// the end of the converter's range, or beyond largest_A, is not used: a broken wire is no current.
///
///     AdcCurrents adc(settings);
///     while (...) {
///         adc.poll(now_us);                                     // CLOCK_MONOTONIC; at least every tick
///         if (adc.take(currents)) {                             // means over what came since the last take()
///             read_spindle(spindle, now_us, motion);            // CounterInput
///             tick.step(join(currents, motion), program);
///         }
///     }
///
/// No heap; no call blocks but for sysfs reads of a slow converter. One thread. A buffered device has one reader.

namespace millforce::iio {

enum class AdcMode : std::uint8_t { buffered, polled };

struct AdcChannel {
    ChannelName name{};      ///< `voltage0`; empty: this drive is not wired
    float A_per_V = 0.0F;    ///< rms; negative: the sensor counts against the motor
    float zero_V = 0.0F;     ///< of the sensor at 0 A
    float largest_A = 0.0F;  ///< beyond it the value is not used
};

/// Defaults of what machine.toml gives are the program's (parameters/local_io.hpp).
struct AdcSettings {
    Path device{};  ///< folder in sysfs: /sys/bus/iio/devices/iio:device0
    Path buffer{};  ///< /dev/iio:device0; buffered mode
    AdcMode mode = AdcMode::buffered;
    /// Writes which elements are on, the buffer's length and its start. Else somebody did, and the layout is only read.
    /// The trigger, and its rate, are the system's to set in either case.
    bool configures = false;
    std::uint32_t buffer_scans = 0;
    std::array<AdcChannel, drive_capacity> channels{};  ///< spindle, x, y, z
    std::uint32_t sample_period_us = 0;                 ///< of the device, to detect gaps; 0: gaps are not detected
    std::uint32_t stale_us = 0;                         ///< without a value for so long the state is `silent`
    std::uint32_t look_period_us = 100'000;             ///< between tries to open
};

enum class AdcState : std::uint8_t {
    absent,   ///< a file is missing, or the device was removed; opened again as soon as it is back
    refused,  ///< the device is present but a file is not understood: `fault` says which; tried again
    silent,   ///< open, and nothing came for stale_us; left by the next value
    running,
};

enum class AdcReject : std::uint8_t {
    at_rail,        ///< lowest or highest value of the converter (buffered)
    current_range,  ///< beyond largest_A
    unreadable,     ///< in_voltage0_raw did not hold a number (polled)
};
inline constexpr std::size_t adc_rejects = 3;

struct AdcHealth {
    AdcState state = AdcState::absent;
    Fault fault{};  ///< of the last failure
    std::uint32_t opened = 0;
    std::uint32_t scans = 0;     ///< wraps
    std::uint32_t overruns = 0;  ///< scans that are missing between two timestamps
    std::array<std::uint32_t, adc_rejects> rejects{};
};

class AdcCurrents {
  public:
    explicit AdcCurrents(const AdcSettings& settings) : settings_(settings) {}
    ~AdcCurrents() { close(); }
    AdcCurrents(const AdcCurrents&) = delete;
    AdcCurrents& operator=(const AdcCurrents&) = delete;

    void poll(std::uint64_t now_us);
    /// False where nothing came since the last call; a channel without a usable value is absent.
    [[nodiscard]] bool take(CurrentReading& reading);
    [[nodiscard]] const AdcHealth& health() const { return health_; }
    [[nodiscard]] std::uint32_t rejected(AdcReject reason) const {
        return health_.rejects[static_cast<std::size_t>(reason)];
    }

  private:
    struct Conversion {
        float scale_V = 0.0F;
        float offset = 0.0F;
        ScanFormat format{};
        std::uint32_t first_byte = 0;
    };
    struct Mean {
        float sum_A = 0.0F;
        std::uint32_t count = 0;
    };

    void open(std::uint64_t now_us);
    [[nodiscard]] Fault prepare();
    [[nodiscard]] Fault read_conversion(std::size_t place);
    [[nodiscard]] Fault prepare_buffer();
    [[nodiscard]] Fault start_buffer();
    [[nodiscard]] Fault open_raw_files();
    [[nodiscard]] Fault read_clock();
    void close();
    void fail(const Fault& fault);

    void fetch_scans(std::uint64_t now_us);
    void take_scan(std::span<const std::uint8_t> scan, std::uint64_t now_us);
    void watch_gap(std::int64_t time_ns);
    void read_raw_files(std::uint64_t now_us);
    void add(std::size_t place, std::int64_t raw);
    void reject(AdcReject reason);
    [[nodiscard]] bool is_wired(std::size_t place) const { return settings_.channels[place].name[0] != '\0'; }

    AdcSettings settings_;
    AdcHealth health_{};
    std::array<Conversion, drive_capacity> conversions_{};
    std::array<Mean, drive_capacity> means_{};
    std::array<int, drive_capacity> raw_files_{-1, -1, -1, -1};
    int buffer_file_ = -1;
    ScanLayout layout_{};
    std::array<std::uint8_t, 4096> bytes_{};
    std::size_t byte_count_ = 0;
    const ScanElement* timestamp_ = nullptr;
    int clock_ = 0;
    std::int64_t last_time_ns_ = 0;
    bool has_new_ = false;
    std::uint64_t newest_us_ = 0;
    std::uint64_t heard_us_ = 0;
    std::uint64_t next_look_us_ = 0;
};

}  // namespace millforce::iio
