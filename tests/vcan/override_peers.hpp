// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bus_peers.hpp"
#include "override_frame/override_receiver.hpp"
#include "override_frame/override_sender.hpp"
#include "override_sender_settings.hpp"

/// The two ends of the override's way over a bus.

namespace millforce::vcan {

/// A controller that ticks once a millisecond and says 80 %.
inline void run_controller() {
    socketcan::CanSocket socket(on(controller_interface()));
    override_frame::OverrideSender sender{test::an_override_sender()};
    for (std::uint32_t heartbeat = 1;; ++heartbeat) {
        const std::uint64_t now_us = socketcan::monotonic_us();
        socket.poll(now_us);
        sender.update({0.8F, false, 3, 0, heartbeat}, now_us);
        sender.poll(now_us);
        hal::CanFrame frame;
        while (sender.take_frame(frame)) {
            socket.send(frame);
        }
        usleep(1000);
    }
}

class Cnc {
  public:
    Cnc() : listener_(on(peer_interface())), receiver_(settings()) {}
    bool run_until_alive(bool expected) {
        return run_until([&] { return last_.is_alive == expected; });
    }
    bool run_until_taken(std::size_t frames) {
        return run_until([&] { return taken_ >= frames; });
    }
    /// What was known when the wait ended: by now the time-out may be over.
    [[nodiscard]] const override_frame::ReceivedOverride& last() const { return last_; }

  private:
    bool run_until(const std::function<bool()>& holds) {
        return listener_.run_until([&] {
            for (; taken_ < listener_.frames.size(); ++taken_) {
                receiver_.on_frame(listener_.frames[taken_], listener_.times_us[taken_]);
            }
            last_ = receiver_.current(socketcan::monotonic_us());
            return holds();
        });
    }
    static override_frame::OverrideReceiverSettings settings() {
        override_frame::OverrideReceiverSettings settings;
        settings.timeout_us = 100'000;
        return settings;
    }
    Listener listener_;
    override_frame::OverrideReceiver receiver_;
    override_frame::ReceivedOverride last_{};
    std::size_t taken_ = 0;
};

}  // namespace millforce::vcan
