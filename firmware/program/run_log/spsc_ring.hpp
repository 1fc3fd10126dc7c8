// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>

namespace millforce::host {

/// From one thread to another without a lock. push() and pop() never block nor allocate; a full ring refuses.
template <typename Value, std::size_t capacity>
class SpscRing {
    static_assert((capacity & (capacity - 1)) == 0, "a power of two");

  public:
    bool push(const Value& value) {
        const std::size_t end = end_.load(std::memory_order_relaxed);
        if (end - begin_.load(std::memory_order_acquire) == capacity) {
            return false;
        }
        values_[end % capacity] = value;
        end_.store(end + 1, std::memory_order_release);
        return true;
    }
    bool pop(Value& value) {
        const std::size_t begin = begin_.load(std::memory_order_relaxed);
        if (begin == end_.load(std::memory_order_acquire)) {
            return false;
        }
        value = values_[begin % capacity];
        begin_.store(begin + 1, std::memory_order_release);
        return true;
    }

  private:
    std::array<Value, capacity> values_{};
    std::atomic<std::size_t> begin_{0};
    std::atomic<std::size_t> end_{0};
};

}  // namespace millforce::host
