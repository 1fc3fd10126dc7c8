// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/drive_sample.hpp"

/// Where a DriveSample comes from: drives on a CiA 402 bus, converters and counters of Linux IIO, registers of a chip,
/// a CNC on the same computer. A new family of drives is a new DriveSource; estimation, control and the tick do not
/// change for it.
///
///     source.poll(now_us);                        // once per sample period: what is read from a device is read now
///     if (source.take_sample(sample)) { ... }     // each sample once
///
/// Two sources may serve one machine: one whose samples set the pace, and another that adds what the first cannot know,
/// e.g. motor currents by a converter to motion by a bus. Each says by `present` and `part` what it knows of a sample,
/// and add() joins the two. A tick runs where `present` holds everything that complete() of the sources names; what an
/// incomplete sample means is the supervisor's to judge, not the source's.
///
/// A source does not extrapolate and does not repeat: a quantity that did not come, is stale or out of its range is
/// absent. Values are in the units of DriveSample. `time_us` is when the drives latched the values, not when they
/// arrived, by a clock that does not run backwards.
///
/// Neither call waits for a drive, allocates or throws. One thread. Sources that frames or messages feed have a
/// function for them as well (on_frame(), on_message()); for these poll() may come as often as wanted.

namespace millforce::hal {

enum class SourceState : std::uint8_t {
    waiting,  ///< no sample yet: a device is absent, or a drive is being prepared; left by the first sample
    running,  ///< samples come
    silent,   ///< samples were due and did not come; left by the next one
};

class DriveSource {
  public:
    /// At least once per sample period.
    virtual void poll(std::uint64_t now_us) = 0;
    /// True where there is a sample that was not handed over before.
    [[nodiscard]] virtual bool take_sample(DriveSample& sample) = 0;
    /// Mask of Present: what this source, perhaps with another one, gives when all is well.
    [[nodiscard]] virtual std::uint8_t complete() const = 0;
    /// For the supervisor; each source's own health says why.
    [[nodiscard]] virtual SourceState state() const = 0;

  protected:
    DriveSource() = default;
    ~DriveSource() = default;  // never deleted through this interface: that would need a heap
    DriveSource(const DriveSource&) = default;
    DriveSource& operator=(const DriveSource&) = default;
};

}  // namespace millforce::hal
