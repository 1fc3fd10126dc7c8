// SPDX-License-Identifier: Apache-2.0
#include "loop/recorder.hpp"

namespace millforce::sim {

hal::FeedOverride Recorder::step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    const hal::FeedOverride output = controller_.step(sample, program);
    keep_({sample, program, output.ratio});
    return output;
}

}  // namespace millforce::sim
