// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/tick.hpp"

namespace millforce::firmware {

/// Whatever knows what lies ahead, a part map for instance. Called once for each sample, between the tick's estimate
/// and its answer, from the tick's thread; it calls tick.set_way_ahead().
template <typename Scalar>
class WaySource {
  public:
    virtual void look_ahead(ForceControlTick<Scalar>& tick, const hal::ProgramStatus& program) = 0;

  protected:
    ~WaySource() = default;
};

}  // namespace millforce::firmware
