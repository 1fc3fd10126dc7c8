// SPDX-License-Identifier: Apache-2.0
#include "override_peers.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::override_frame;
using namespace millforce::vcan;

TEST_GROUP(OverrideOnVcan){};

TEST(OverrideOnVcan, frames_forged_by_cansend_are_not_used) {
    Cnc cnc;
    for (const char* forged : {"1FE#401F000300010000", "1FE#401F0003000200", "1FE#R", "1FE##0401F000300030000"}) {
        LONGS_EQUAL(0, shell(std::string("cansend vcan0 ") + forged));
    }
    CHECK(cnc.run_until_taken(3));  // the fourth is CAN FD, which the socket keeps out
    CHECK_FALSE(cnc.last().is_alive);
}

TEST(OverrideOnVcan, is_the_documented_bytes_to_candump) {
    const Candump candump("vcan0");
    socketcan::CanSocket socket(on("vcan0"));
    socket.poll(socketcan::monotonic_us());
    CHECK(socket.send(encode({0.8F, false, 3, 0, 0x1234}, default_id)));
    CHECK(candump.has("1FE#"));
    const auto frames = candump.frames();
    UNSIGNED_LONGS_EQUAL(1, frames.size());
    STRCMP_EQUAL("1FE#401F0003003412", frames[0].substr(0, 18).c_str());
}
