// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "iio/attribute.hpp"
#include "iio/sample_join.hpp"

namespace millforce::iio {

/// An encoder at a counter of Linux, read as a file: the counter subsystem's
/// /sys/bus/counter/devices/counter0/count0/count, or IIO's in_count0_raw. Defaults are the program's
/// (parameters/local_io.hpp).
struct CounterSettings {
    Path count_file{};
    std::uint32_t modulus = 0;       ///< counts after which it begins again at 0: the file `ceiling` plus 1; 0: 2³²
    std::uint32_t largest_step = 0;  ///< between two reads; beyond it the value is not used, and followed from
    bool reversed = false;
    float mm_per_count = 0.0F;  ///< of a feed axis; 0: of the spindle
};

struct CounterHealth {
    bool is_ready = false;  ///< the last read gave a count
    Fault fault{};          ///< of the last failure
    std::uint32_t opened = 0;
    std::uint32_t steps_too_large = 0;
};

/// The count unwrapped, and the speed since the read before. Opens itself again, at every read. No heap; one thread.
class CounterInput {
  public:
    explicit CounterInput(const CounterSettings& settings) : settings_(settings) {}
    ~CounterInput() { close(); }
    CounterInput(const CounterInput&) = delete;
    CounterInput& operator=(const CounterInput&) = delete;

    /// False if there is no count; `count` and `velocity_mm_s` then stay.
    [[nodiscard]] bool read(std::uint64_t now_us);
    [[nodiscard]] std::uint32_t count() const { return count_; }
    /// False until two reads in sequence gave a count.
    [[nodiscard]] bool has_velocity() const { return has_velocity_; }
    [[nodiscard]] float velocity_mm_s() const { return velocity_mm_s_; }
    [[nodiscard]] const CounterHealth& health() const { return health_; }

  private:
    [[nodiscard]] bool read_raw(std::int64_t& raw);
    [[nodiscard]] std::int64_t step_from_last(std::int64_t raw) const;
    void close();

    CounterSettings settings_;
    CounterHealth health_{};
    int file_ = -1;
    bool has_last_ = false;
    std::int64_t last_raw_ = 0;
    std::uint64_t last_us_ = 0;
    std::uint32_t count_ = 0;
    bool has_velocity_ = false;
    float velocity_mm_s_ = 0.0F;
};

/// Reads into the spindle's part, or an axis's; absent if there is no count.
void read_spindle(CounterInput& counter, std::uint64_t now_us, MotionReading& motion);
void read_axis(CounterInput& counter, std::uint64_t now_us, std::size_t axis, MotionReading& motion);

}  // namespace millforce::iio
