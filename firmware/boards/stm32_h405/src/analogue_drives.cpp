// SPDX-License-Identifier: Apache-2.0
#include "stm32_h405/analogue_drives.hpp"

namespace millforce::stm32_h405 {

namespace {

stm32::EncoderSettings axis_encoder(const AxisWiring& axis) {
    return {.reversed = axis.reversed};
}

}  // namespace

AnalogueDrives::AnalogueDrives(const Peripherals& p, const Wiring& wiring)
    : wiring_(wiring),
      spindle_(p.spindle_timer,
               {.is_32_bit = true, .reversed = wiring.spindle_reversed, .has_index = wiring.has_index}),
      axes_{stm32::Encoder(*p.axis_timers[0], axis_encoder(wiring.axes[0])),
            stm32::Encoder(*p.axis_timers[1], axis_encoder(wiring.axes[1])),
            stm32::Encoder(*p.axis_timers[2], axis_encoder(wiring.axes[2]))},
      currents_(p.adc, p.adc_common, p.dma, wiring.currents) {}

void AnalogueDrives::start() {
    spindle_.start();
    for (stm32::Encoder& axis : axes_) {
        axis.start();
    }
    currents_.start();
}

void AnalogueDrives::poll(std::uint64_t now_us) {
    const stm32::ScanReading currents = currents_.take();
    sample_ = {};
    sample_.time_us = static_cast<std::uint32_t>(now_us);
    read_spindle(currents, sample_);
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        read_axis(axis, currents, sample_);
    }
    has_sample_ = true;
    state_ = currents.scans > 0 ? hal::SourceState::running : hal::SourceState::silent;
}

void AnalogueDrives::read_spindle(const stm32::ScanReading& currents, hal::DriveSample& sample) {
    const stm32::EncoderReading spindle = spindle_.read();
    sample.spindle_count = spindle.count;
    sample.spindle_index_count = spindle.index_count;
    sample.spindle_index_number = spindle.index_number;
    sample.spindle_current_A = currents.current_A[0];
    if (currents.has[0]) {
        hal::set_present(sample, hal::Present::spindle_current);
    }
    if (!wiring_.has_index || encoder_watch_.is_plausible(spindle.count, spindle.index_count, spindle.index_number)) {
        hal::set_present(sample, hal::Present::spindle_count);
    }
}

void AnalogueDrives::read_axis(std::size_t axis, const stm32::ScanReading& currents, hal::DriveSample& sample) {
    sample.axis_current_A[axis] = currents.current_A[1U + axis];
    sample.axis_velocity_mm_s[axis] =
        velocities_[axis].update(axes_[axis].read().count, sample.time_us, wiring_.axes[axis].mm_per_count);
    hal::set_known(sample, axis, currents.has[1U + axis], true);
}

bool AnalogueDrives::take_sample(hal::DriveSample& sample) {
    if (!has_sample_) {
        return false;
    }
    has_sample_ = false;
    sample = sample_;
    return true;
}

}  // namespace millforce::stm32_h405
