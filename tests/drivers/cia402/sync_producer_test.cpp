// SPDX-License-Identifier: Apache-2.0
#include "cia402/sync_producer.hpp"

#include <CppUTest/TestHarness.h>

#include "cia402/objects.hpp"

using namespace millforce;
using namespace millforce::cia402;

TEST_GROUP(SyncProducer){};

TEST(SyncProducer, sends_one_sync_where_it_was_polled_late_not_a_burst) {
    SyncProducer producer(cob_id::sync, 1000);
    hal::CanFrame sent;
    int syncs = 0;
    for (const std::uint64_t now_us : {1000ULL, 2000ULL, 9500ULL, 9600ULL, 10'000ULL}) {
        producer.poll(now_us);
        while (producer.take_frame(sent)) {
            syncs += sent.id == cob_id::sync ? 1 : 0;
        }
    }
    LONGS_EQUAL(4, syncs);
    UNSIGNED_LONGS_EQUAL(6, producer.skipped());
}
