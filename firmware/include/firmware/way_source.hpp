// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "firmware/tick.hpp"
#include "hal/can_frame.hpp"

namespace millforce::firmware {

/// Whatever knows what lies ahead, a part map for instance. From the tick's thread alone.
template <typename Scalar>
class WaySource {
  public:
    /// Called once for each sample, between the tick's estimate and its answer; it calls tick.set_way_ahead().
    virtual void look_ahead(ForceControlTick<Scalar>& tick, const hal::ProgramStatus& program) = 0;

    /// With tools by number: another one is in the spindle, at rest. What was known of the way was for the last one.
    virtual void set_tool(std::uint32_t) {}
    /// What it knew of the way did not fit the cut: nothing more is taken from it.
    [[nodiscard]] virtual bool is_refuted() const { return false; }

    /// One that has its map over the controller's CAN bus: the id of the frames that it hears; 0: none.
    [[nodiscard]] virtual std::uint32_t frame_id() const { return 0; }
    virtual void on_frame(const hal::CanFrame&) {}
    /// The controller begins anew: what frames have said is forgotten.
    virtual void begin_again() {}
    /// To be sent. False where there is none.
    [[nodiscard]] virtual bool take_frame(hal::CanFrame&) { return false; }

  protected:
    ~WaySource() = default;
};

}  // namespace millforce::firmware
