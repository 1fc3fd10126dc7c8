// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

/// What the process holds of memory.

namespace millforce::soak {

struct MemoryInUse {
    std::uint64_t allocations = 0;  ///< calls of operator new since the start
    std::size_t heap_bytes = 0;     ///< allocated and not freed
    std::size_t resident_KiB = 0;   ///< in RAM, of what no file holds: stacks, heap, data
};

[[nodiscard]] MemoryInUse memory_in_use();

/// The more of each.
[[nodiscard]] inline MemoryInUse largest(const MemoryInUse& a, const MemoryInUse& b) {
    return {std::max(a.allocations, b.allocations), std::max(a.heap_bytes, b.heap_bytes),
            std::max(a.resident_KiB, b.resident_KiB)};
}

}  // namespace millforce::soak
