#pragma once

#include <deque>

#include "live/can_port.hpp"
#include "zynqmp/can_controller.hpp"

namespace millforce::target {

/// The generic timer: Arm Architecture Reference Manual D11
inline std::uint64_t timer_us() {
    std::uint64_t count = 0;
    std::uint64_t frequency_hz = 0;
    asm volatile("isb\n mrs %0, cntvct_el0\n mrs %1, cntfrq_el0" : "=r"(count), "=r"(frequency_hz));
    return count * 1'000'000U / frequency_hz;
}

/// The plant's end of the bus: CAN 1.
class BarePort final : public sim::CanPort {
  public:
    BarePort() { can_.start(zynqmp::kbit_1000); }

    [[nodiscard]] std::uint64_t now_us() override { return timer_us(); }
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
    void send(const hal::CanFrame& frame) override {
        sent += can_.send(frame) ? 1U : 0U;
    }
    void wait(std::uint64_t timeout_us) override {
        const std::uint64_t end_us = timer_us() + timeout_us;
        std::uint64_t time_us = 0;
        do {
            let_time_pass();
            time_us = timer_us();
            poll(time_us);
        } while (heard_.empty() && time_us < end_us);
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

    /// The registers are looked at every 3 µs or so: each look costs the emulator more than the waiting, but what the
    /// drives latch late is noise in the spindle's acceleration.
    static void let_time_pass() {
        for (unsigned k = 0; k < 1500; ++k) {
            asm volatile("" ::: "memory");
        }
        asm volatile("yield");
    }

    zynqmp::CanController can_{*reinterpret_cast<zynqmp::CanRegisters*>(zynqmp::address::can1)};
    std::deque<Heard> heard_{};
};

}  // namespace millforce::target
