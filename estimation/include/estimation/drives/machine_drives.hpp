// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "estimation/drives/feed_drive.hpp"
#include "estimation/drives/spindle_drive.hpp"

namespace millforce::estimation {

/// The drives of a machine, with what was learnt of them in air: idle torque and friction. Nothing in them depends on
/// the tool. Some 300 bytes in float. No heap; not thread-safe.
template <typename Scalar>
struct MachineDrives {
    MachineDrives(const SpindleDriveParameters<Scalar>& of_spindle,
                  const std::array<FeedDriveParameters<Scalar>, 3>& of_axes)
        : spindle(of_spindle),
          axes{FeedDrive<Scalar>(of_axes[0]), FeedDrive<Scalar>(of_axes[1]), FeedDrive<Scalar>(of_axes[2])} {}

    /// Time passes: the drifts may have moved.
    void predict(Scalar dt_s) {
        spindle.predict(dt_s);
        for (FeedDrive<Scalar>& axis : axes) {
            axis.predict(dt_s);
        }
    }

    /// What was learnt in air was none: back to the calibration.
    void forget() {
        spindle.forget();
        for (FeedDrive<Scalar>& axis : axes) {
            axis.forget();
        }
    }

    SpindleDrive<Scalar> spindle;
    std::array<FeedDrive<Scalar>, 3> axes;
};

}  // namespace millforce::estimation
