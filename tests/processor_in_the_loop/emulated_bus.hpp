#pragma once

#include <cstdlib>
#include <deque>
#include <string>

#include "emulator_pipes.hpp"
#include "live/can_port.hpp"
#include "target/zcu102/bus_exchange.hpp"

namespace millforce {

/// The plant's CAN controller on an emulated zcu102, at whose other one the Cortex-R5F's controller is. The emulator's
/// time stands still while the plant computes.
class EmulatedBus final : public sim::CanPort {
  public:
    /// `parameters`: a file that holds a parameter block.
    EmulatedBus(EmulatorPipes& pipes, const std::string& parameters) : pipes_(pipes) {
        const std::string source = MILLFORCE_SOURCE_DIR;
        const std::string build = source + "/build/cortex-r5f";
        setenv("MILLFORCE_ICOUNT", "1", 1);
        setenv("MILLFORCE_PARAMETERS", parameters.c_str(), 1);
        pipes_.start({source + "/toolchains/run-on-zcu102", build + "/tests/target/zcu102/bus_peer.elf",
                      build + "/firmware/boards/zcu102/millforce_zcu102.elf"});
        unsetenv("MILLFORCE_PARAMETERS");
        unsetenv("MILLFORCE_ICOUNT");
        exchange(0);
    }

    [[nodiscard]] std::uint64_t now_us() override { return now_us_; }
    void poll(std::uint64_t) override {}
    [[nodiscard]] bool receive(hal::CanFrame& frame, std::uint64_t& time_us) override {
        if (heard_.empty()) {
            return false;
        }
        frame = heard_.front().frame;
        time_us = heard_.front().time_us;
        heard_.pop_front();
        return true;
    }
    void send(const hal::CanFrame& frame) override {
        ++sent;
        orders_.frames[orders_.count++] = frame;
        if (orders_.count == orders_.frames.size()) {
            exchange(0);
        }
    }
    void wait(std::uint64_t timeout_us) override { exchange(static_cast<std::uint32_t>(timeout_us)); }

    std::uint64_t sent = 0;
    std::uint64_t received = 0;
    std::uint32_t lost = 0;

  private:
    void exchange(std::uint32_t wait_us) {
        orders_.wait_us = wait_us;
        pipes_.tell(orders_);
        orders_ = {};
        const auto report = pipes_.hear<bus_exchange::Report>();
        // Without an emulator the time goes on: who waits for something gives up some day.
        now_us_ = pipes_.works() ? report.now_us : now_us_ + wait_us + 1;
        lost = report.lost;
        received += report.count;
        heard_.insert(heard_.end(), report.heard.begin(), report.heard.begin() + report.count);
    }

    EmulatorPipes& pipes_;
    bus_exchange::Orders orders_{};
    std::deque<bus_exchange::Heard> heard_{};
    std::uint64_t now_us_ = 0;
};

}  // namespace millforce
