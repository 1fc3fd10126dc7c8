// SPDX-License-Identifier: Apache-2.0
#include "bus_bench.hpp"

#include <CppUTest/TestHarness.h>

#include <random>

using namespace millforce;
using namespace millforce::cia402;
using namespace millforce::cia402::bench;

TEST_GROUP(PdoMapping){};

TEST(PdoMapping, any_width_at_any_bit_is_read_as_it_was_written) {
    std::mt19937_64 random(3);
    for (int k = 0; k < 100'000; ++k) {
        const unsigned bits = 1 + static_cast<unsigned>(random() % 32);
        const unsigned first = static_cast<unsigned>(random() % (65 - bits));
        const std::uint64_t all = random();
        std::array<std::uint8_t, 8> data{};
        for (unsigned b = 0; b < 8; ++b) {
            data[b] = static_cast<std::uint8_t>(all >> (8 * b));
        }
        std::uint32_t expected = 0;
        for (unsigned b = 0; b < bits; ++b) {
            expected |= static_cast<std::uint32_t>((all >> (first + b)) & 1U) << b;
        }
        UNSIGNED_LONGS_EQUAL(expected, unsigned_bits(data, first, bits));
    }
}

TEST(PdoMapping, two_s_complement_of_any_width) {
    LONGS_EQUAL(-1, sign_extended(0xFFFF, 16));
    LONGS_EQUAL(-32768, sign_extended(0x8000, 16));
    LONGS_EQUAL(32767, sign_extended(0x7FFF, 16));
    LONGS_EQUAL(-1, sign_extended(1, 1));
    LONGS_EQUAL(-3, sign_extended(0xFFFFFFFDU, 32));
    LONGS_EQUAL(-4, sign_extended(0x1CU, 3));
}

TEST(PdoMapping, names_what_is_wrong_with_it) {
    PdoMapping pdo = first_pdo(1);
    CHECK(check(pdo) == MappingError::none);
    pdo.id = 0x701;
    CHECK(check(pdo) == MappingError::id);
    pdo = first_pdo(1);
    pdo.transmission_type = 252;
    CHECK(check(pdo) == MappingError::transmission_type);
    pdo = first_pdo(1);
    pdo.object_count = 200;
    CHECK(check(pdo) == MappingError::object_count);
    pdo = first_pdo(1);
    pdo.objects[1].bits = 0;
    CHECK(check(pdo) == MappingError::object_width);
    pdo = first_pdo(1);
    pdo.objects[1].bits = 17;
    CHECK(check(pdo) == MappingError::too_long);
}

TEST_GROUP(Settings){};

TEST(Settings, name_what_is_wrong_with_them) {
    const auto wrong = [](auto change) {
        BusSettings settings = two_drives();
        change(settings);
        return check(settings);
    };
    CHECK(wrong([](BusSettings&) {}) == SettingsError::none);
    CHECK(wrong([](BusSettings& s) { s.drives = {}; }) == SettingsError::no_drive);
    CHECK(wrong([](BusSettings& s) { s.drives[1].node_id = 1; }) == SettingsError::node_id);
    CHECK(wrong([](BusSettings& s) { s.drives[1].node_id = 128; }) == SettingsError::node_id);
    CHECK(wrong([](BusSettings& s) { s.drives[1].pdos[0].id = 0x181; }) == SettingsError::id_used_twice);
    CHECK(wrong([](BusSettings& s) { s.drives[0].pdos[0].objects[1].index = 0x6079; }) ==
          SettingsError::object_missing);
    CHECK(wrong([](BusSettings& s) { s.is_master = false; }) == SettingsError::rated_value);
    CHECK(wrong([](BusSettings& s) { s.drives[1].rated_current_A = -1.0F; }) == SettingsError::rated_value);
    CHECK(wrong([](BusSettings& s) { s.drives[1].position_mm_per_unit = 0.0F; }) == SettingsError::unit);
    CHECK(wrong([](BusSettings& s) { s.drives[0].largest_share_of_rated = 0.0F; }) == SettingsError::limit);
    CHECK(wrong([](BusSettings& s) { s.drives[0].count_modulus = 1; }) == SettingsError::limit);
    CHECK(wrong([](BusSettings& s) { s.sync_period_us = 0; }) == SettingsError::sync);
    CHECK(wrong([](BusSettings& s) { s.collect_us = 2000; }) == SettingsError::sync);
    CHECK(wrong([](BusSettings& s) {
              s.drives[0].pdos[0].object_count = 1;
              s.drives[0].pdos[0].objects[0].bits = 64;
          }) == SettingsError::object_width);
}

TEST(Settings, that_are_wrong_make_a_bus_that_does_nothing) {
    BusSettings settings = two_drives();
    settings.sync_period_us = 0;
    DriveBus bus(settings);
    hal::CanFrame sent;
    for (std::uint64_t now_us = 0; now_us < 10'000; now_us += 100) {
        bus.poll(now_us);
        bus.on_frame(frame_of(0x181, {0, 0, 0, 0, 0, 0, 0, 0}), now_us);
    }
    CHECK_FALSE(bus.take_frame(sent));
}

TEST_GROUP(Statusword){};

TEST(Statusword, each_pattern_of_the_standard_is_its_state) {
    CHECK(power_state(0x0000) == PowerState::not_ready_to_switch_on);
    CHECK(power_state(0x0250) == PowerState::switch_on_disabled);
    CHECK(power_state(0x0231) == PowerState::ready_to_switch_on);
    CHECK(power_state(0x0233) == PowerState::switched_on);
    CHECK(power_state(0x0237) == PowerState::operation_enabled);
    CHECK(power_state(0x0217) == PowerState::quick_stop_active);
    CHECK(power_state(0x021F) == PowerState::fault_reaction_active);
    CHECK(power_state(0x0218) == PowerState::fault);
    CHECK(power_state(0x0001) == PowerState::unknown);
}

TEST_GROUP(Sdo){};

TEST(Sdo, an_answer_is_used_only_if_it_answers_what_was_asked) {
    SdoClient client(5);
    RejectCounters rejects;
    hal::CanFrame request;
    client.ask({0x6075, 0, 0, 0}, 0);
    CHECK(client.take_frame(request));
    UNSIGNED_LONGS_EQUAL(0x605, request.id);
    client.on_frame(frame_of(0x585, {0x43, 0x76, 0x60, 0, 1, 2, 3, 4}), rejects);  // another object
    client.on_frame(frame_of(0x585, {0x43, 0x75, 0x60, 1, 1, 2, 3, 4}), rejects);  // another subindex
    client.on_frame(frame_of(0x585, {0x60, 0x75, 0x60, 0, 0, 0, 0, 0}), rejects);  // a write's answer
    client.on_frame(frame_of(0x585, {0x43, 0x75, 0x60, 0}), rejects);
    CHECK(client.state() == SdoState::pending);
    UNSIGNED_LONGS_EQUAL(4, rejects.total());
    client.on_frame(frame_of(0x585, {0x4B, 0x75, 0x60, 0, 0x10, 0x27, 0xEE, 0xEE}), rejects);  // two bytes
    CHECK(client.state() == SdoState::done);
    UNSIGNED_LONGS_EQUAL(10'000, client.value());
}

TEST(Sdo, a_segmented_answer_is_aborted) {
    SdoClient client(5);
    RejectCounters rejects;
    hal::CanFrame sent;
    client.ask({0x1008, 0, 0, 0}, 0);
    CHECK(client.take_frame(sent));
    client.on_frame(frame_of(0x585, {0x41, 0x08, 0x10, 0, 20, 0, 0, 0}), rejects);
    CHECK(client.state() == SdoState::aborted);
    CHECK(client.take_frame(sent));
    UNSIGNED_LONGS_EQUAL(0x80, sent.data[0]);
}

TEST(Sdo, silence_is_asked_again_twice_and_then_told) {
    SdoClient client(5);
    hal::CanFrame sent;
    client.ask({0x6075, 0, 0, 0}, 0);
    int requests = 0;
    for (std::uint64_t t = 0; t < 1'000'000; t += 1000) {
        client.poll(t);
        requests += client.take_frame(sent) ? 1 : 0;
    }
    LONGS_EQUAL(3, requests);
    CHECK(client.state() == SdoState::silent);
}
