// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "bus/can_port.hpp"
#include "target/zcu102_plant/emulated_time.hpp"
#include "zynqmp/can_controller.hpp"

namespace millforce::target {

/// By the generic timer, which counts the emulator's time.
inline std::uint64_t timer_us() {
    std::uint64_t count = 0;
    asm volatile("isb\n mrs %0, cntvct_el0" : "=r"(count));
    return count * 1000U / timer_counts_per_ms();
}

/// The plant's end of the bus: CAN 1.
class BarePort final : public host::CanPort {
  public:
    BarePort() { can_.start(zynqmp::kbit_1000); }

    /// Until then no time passes.
    void begin_time() {
        began_us_ = timer_us();
        time_passes_ = true;
    }
    [[nodiscard]] std::uint64_t now_us() override { return time_passes_ ? timer_us() - began_us_ : 0; }
    void poll(std::uint64_t now_us) override {
        can_.poll();
        hal::CanFrame frame;
        while (can_.receive(frame)) {
            heard_.push_back({now_us, frame});
            ++received;
        }
    }
    [[nodiscard]] bool receive(hal::CanFrame& frame, std::uint64_t& time_us) override {
        if (heard_.empty()) {
            return false;
        }
        time_us = heard_.front().time_us;
        frame = heard_.front().frame;
        heard_.pop_front();
        return true;
    }
    void send(const hal::CanFrame& frame) override { sent += can_.send(frame) ? 1U : 0U; }
    void wait(std::uint64_t timeout_us) override {
        const std::uint64_t end_us = now_us() + timeout_us;
        std::uint64_t time_us = 0;
        do {
            let_time_pass();
            time_us = now_us();
            poll(time_us);
        } while (heard_.empty() && time_us < end_us);
    }
    /// The controller takes a frame at each of its rounds: enough of them for the drives' PDOs and the tick behind
    /// them.
    static void let_controller_work() {
        constexpr unsigned rounds = 16;
        for (unsigned k = 0; k < rounds; ++k) {
            asm volatile("yield" ::: "memory");
        }
    }

    [[nodiscard]] bool is_on_bus() const { return can_.is_on_bus(); }
    [[nodiscard]] std::uint64_t lost() const { return can_.health().unsent + can_.health().overruns; }

    std::uint64_t sent = 0;
    std::uint64_t received = 0;

  private:
    struct Heard {
        std::uint64_t time_us;
        hal::CanFrame frame;
    };

    /// The registers are looked at every 8 µs: each look costs an emulator more than the waiting, and nothing is
    /// cheaper to it than what does nothing.
    static void let_time_pass() {
        for (unsigned k = 0; k < 8 * emulated_ns_per_us / 1000; ++k) {
            asm volatile(".rept 1000\n nop\n .endr" ::: "memory");
        }
        asm volatile("yield");
    }

    zynqmp::CanController can_{*reinterpret_cast<zynqmp::CanRegisters*>(zynqmp::address::can1)};
    std::deque<Heard> heard_{};
    std::uint64_t began_us_ = 0;
    bool time_passes_ = false;
};

}  // namespace millforce::target
