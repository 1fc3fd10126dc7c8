// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/drive_source.hpp"
#include "local_link/messages.hpp"

namespace millforce::firmware {

/// Drives that another program reads, e.g. LinuxCNC by its HAL pins: each message brings one sample, with its time. It
/// is complete by what its sender says is there. No heap; one thread.
class LinkDrives final : public hal::DriveSource {
  public:
    void on_message(const local_link::SampleMessage& message);

    void poll(std::uint64_t) override {}  // messages alone feed it
    [[nodiscard]] bool take_sample(hal::DriveSample& sample) override;
    [[nodiscard]] std::uint8_t complete() const override { return sample_.present; }
    [[nodiscard]] hal::SourceState state() const override { return state_; }

  private:
    hal::DriveSample sample_{};
    bool has_sample_ = false;
    hal::SourceState state_ = hal::SourceState::waiting;
};

}  // namespace millforce::firmware
