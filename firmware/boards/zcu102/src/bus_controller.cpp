#include "zcu102/bus_controller.hpp"

namespace millforce::zcu102 {

namespace {
constexpr std::uint64_t off_the_bus_us = 100'000;
}

void BusController::start(const zynqmp::CanBitTiming& timing) {
    timing_ = timing;
    can_.start(timing);
}

void BusController::rejoin_after_bus_off(std::uint64_t now_us) {
    if (can_.state() != zynqmp::CanState::bus_off) {
        on_bus_us_ = now_us;
    } else if (now_us >= on_bus_us_ + off_the_bus_us) {
        can_.start(timing_);
    }
}

void BusController::poll(std::uint64_t now_us) {
    can_.poll();
    rejoin_after_bus_off(now_us);
    hal::CanFrame frame;
    while (can_.receive(frame)) {
        controller_.on_frame(frame, now_us, false);
    }
    controller_.poll(now_us);
    while (controller_.take_frame(frame)) {
        if (can_.send(frame)) {
            controller_.on_frame(frame, now_us, true);
        }
    }
    controller_.work();
}

}  // namespace millforce::zcu102
