// SPDX-License-Identifier: Apache-2.0
#include "cia402/signal_table.hpp"

namespace millforce::cia402 {

namespace {

bool is_at(const MappedObject& object, const ObjectAddress& address) {
    return address.index != 0 && object.index == address.index && object.subindex == address.subindex;
}

}  // namespace

SignalTable::SignalTable(const DriveSettings& settings) {
    for (std::size_t pdo = 0; pdo < settings.pdos.size(); ++pdo) {
        unsigned first_bit = 0;
        for (const MappedObject& object : settings.pdos[pdo].mapped()) {
            if (settings.pdos[pdo].is_used() && first_bit < 64) {
                place_object(settings, object,
                             {static_cast<std::uint8_t>(pdo), static_cast<std::uint8_t>(first_bit), object.bits});
            }
            first_bit += object.bits;
        }
    }
}

void SignalTable::place_object(const DriveSettings& settings, const MappedObject& object, Place where) {
    const auto put = [&](Signal signal, const ObjectAddress& address) {
        Place& place = places_[static_cast<std::size_t>(signal)];
        if (place.bits == 0 && is_at(object, address)) {
            place = where;
        }
    };
    put(Signal::statusword, {object::statusword, 0});
    put(Signal::current, {object::current_actual, 0});
    put(Signal::torque, {object::torque_actual, 0});
    put(Signal::velocity, {object::velocity_actual, 0});
    put(Signal::position, {object::position_actual, 0});
    put(Signal::count, settings.count_object);
    put(Signal::index_count, settings.index_count_object);
    put(Signal::index_number, settings.index_number_object);
}

void SignalTable::take(std::size_t pdo, const std::array<std::uint8_t, hal::largest_can_length>& data) {
    for (std::size_t k = 0; k < signal_count; ++k) {
        if (places_[k].bits != 0 && places_[k].pdo == pdo) {
            raw_[k] = unsigned_bits(data, places_[k].first_bit, places_[k].bits);
        }
    }
}

}  // namespace millforce::cia402
