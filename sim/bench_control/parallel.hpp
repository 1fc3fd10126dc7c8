// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace millforce::sim {

/// Calls body(0) … body(count − 1), each once, on so many threads, in the order of their numbers as threads become
/// free. `progress` is called from this thread with the share done, several times a second. What a body throws ends the
/// rest, and is thrown here.
void run_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body,
                  const std::function<void(double share)>& progress);

}  // namespace millforce::sim
