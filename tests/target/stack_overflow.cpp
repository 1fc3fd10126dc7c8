// SPDX-License-Identifier: Apache-2.0
// Runs its stack over, on purpose: the MPU's guard below it must end the program with a memory fault (exit code 68)
// before a byte outside of the stack is written. Exit code 0: it did not.

#include <cstdint>

#include "common/processor.hpp"
#include "target/semihosting.hpp"

namespace {

std::uint32_t deeper(std::uint32_t depth) {
    volatile std::uint32_t frame[16];
    frame[0] = depth;
    if (depth == 0) {
        return 0;
    }
    return deeper(depth - 1) + frame[0];
}

}  // namespace

void millforce::board::run_image() {
    constexpr std::uint32_t far_beyond = 1'000'000;
    const std::uint32_t sum = deeper(far_beyond);
    target::write_number(sum);
    target::exit_emulator(0);
}
