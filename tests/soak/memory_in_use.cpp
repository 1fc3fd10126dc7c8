// SPDX-License-Identifier: Apache-2.0
#include "soak/memory_in_use.hpp"

#include <malloc.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::uint64_t> allocations{0};

}  // namespace

void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size == 0 ? 1 : size)) {
        return memory;
    }
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace millforce::soak {

namespace {

/// Without the pages of the program's own file, which come with the code that runs.
std::size_t resident_KiB() {
    std::size_t found = 0;
    if (std::FILE* file = std::fopen("/proc/self/status", "r")) {
        std::array<char, 256> line{};
        while (found == 0 && std::fgets(line.data(), static_cast<int>(line.size()), file) != nullptr) {
            unsigned long KiB = 0;
            found = std::sscanf(line.data(), "RssAnon: %lu kB", &KiB) == 1 ? KiB : 0;
        }
        std::fclose(file);
    }
    return found;
}

}  // namespace

MemoryInUse memory_in_use() {
    const std::size_t KiB = resident_KiB();
    return {allocations, mallinfo2().uordblks, KiB};
}

}  // namespace millforce::soak
