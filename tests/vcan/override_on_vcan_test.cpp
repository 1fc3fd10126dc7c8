#include "bus_peers.hpp"

#include "override_frame/override_receiver.hpp"
#include "override_frame/override_sender.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::override_frame;
using namespace millforce::vcan;

namespace {

/// A controller that ticks once a millisecond and says 80 %.
void run_controller() {
    socketcan::CanSocket socket(on("vcan0"));
    OverrideSender sender{OverrideSenderSettings{}};
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
    Cnc() : listener_(on("vcan0")), receiver_(settings()) {}
    bool run_until_alive(bool expected) {
        return listener_.run_until([&] {
            for (; taken_ < listener_.frames.size(); ++taken_) {
                receiver_.on_frame(listener_.frames[taken_], listener_.times_us[taken_]);
            }
            return current().is_alive == expected;
        });
    }
    [[nodiscard]] ReceivedOverride current() const { return receiver_.current(socketcan::monotonic_us()); }

  private:
    static OverrideReceiverSettings settings() {
        OverrideReceiverSettings settings;
        settings.timeout_us = 100'000;
        return settings;
    }
    Listener listener_;
    OverrideReceiver receiver_;
    std::size_t taken_ = 0;
};

}  // namespace

TEST_GROUP(OverrideOnVcan){};

TEST(OverrideOnVcan, reaches_a_cnc_and_a_controller_that_stops_is_a_hold) {
    const Child controller(run_controller);
    Cnc cnc;
    CHECK(cnc.run_until_alive(true));
    DOUBLES_EQUAL(0.8, cnc.current().ratio, 1e-4);
    CHECK_FALSE(cnc.current().hold);
    controller.send_signal(SIGSTOP);
    CHECK(cnc.run_until_alive(false));
    CHECK(cnc.current().hold);
    controller.send_signal(SIGCONT);
    CHECK(cnc.run_until_alive(true));
}

TEST(OverrideOnVcan, frames_forged_by_cansend_are_not_used) {
    Cnc cnc;
    for (const char* forged : {"1FE#401F000300010000", "1FE#401F0003000200", "1FE#R", "1FE##0401F000300030000"}) {
        LONGS_EQUAL(0, shell(std::string("cansend vcan0 ") + forged));
    }
    CHECK_FALSE(cnc.current().is_alive);
    CHECK(cnc.run_until_alive(false));
}

TEST(OverrideOnVcan, is_the_documented_bytes_to_candump) {
    const Candump candump("vcan0");
    socketcan::CanSocket socket(on("vcan0"));
    socket.poll(socketcan::monotonic_us());
    CHECK(socket.send(encode({0.8F, false, 3, 0, 0x1234}, default_id)));
    const auto frames = candump.frames();
    UNSIGNED_LONGS_EQUAL(1, frames.size());
    STRCMP_EQUAL("1FE#401F0003003412", frames[0].substr(0, 18).c_str());
}
