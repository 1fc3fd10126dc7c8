// SPDX-License-Identifier: Apache-2.0
// Starts the Cortex-R5F and sleeps.
#include "target/zcu102/a53.hpp"

void run() {
    using namespace millforce::target;
    if (start_processor(cortex_r5f, image_of_r5f) != 0) {
        exit_emulator(3);
    }
}
