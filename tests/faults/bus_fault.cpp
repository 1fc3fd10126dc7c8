// SPDX-License-Identifier: Apache-2.0
#include "faults/bus_fault.hpp"

#include <iterator>
#include <memory>
#include <random>

#include "override_frame/override_frame.hpp"
#include "program_status/program_status_frame.hpp"

namespace millforce::faults {

namespace {

using Fate = sim::LoopbackBus::Fate;

constexpr std::uint32_t node_bits = 0x7F;
constexpr std::uint32_t spindle_node = 1;  // of the scenarios' machine file
constexpr std::uint32_t x_node = 2;

bool is_from(const hal::CanFrame& frame, std::uint32_t node) {
    constexpr std::uint32_t first_of_nodes = 0x081;
    return frame.id >= first_of_nodes && (frame.id & node_bits) == node;
}

bool is_by_chance(std::mt19937_64& random, double share) {
    return std::bernoulli_distribution(share)(random);
}

Fate altered(hal::CanFrame frame, std::mt19937_64& random) {
    if (frame.length > 0) {
        const auto place = std::uniform_int_distribution<std::size_t>(0, frame.length - 1U)(random);
        frame.data[place] = static_cast<std::uint8_t>(std::uniform_int_distribution(0, 255)(random));
    }
    return {1, 0, frame};
}

Fate fate_of(BusFault fault, const hal::CanFrame& frame, std::mt19937_64& random) {
    constexpr std::uint64_t twice_after_us = 1'000;
    constexpr std::uint64_t latest_us = 20'000;
    const Fate arrives{1, 0, frame};
    const Fate lost{0, 0, frame};
    switch (fault) {
        case BusFault::spindle_silent:
            return is_from(frame, spindle_node) ? lost : arrives;
        case BusFault::x_silent:
            return is_from(frame, x_node) ? lost : arrives;
        case BusFault::status_silent:
            return frame.id == program_status::default_id ? lost : arrives;
        case BusFault::override_lost:
            return frame.id == override_frame::default_id ? lost : arrives;
        case BusFault::bus_dead:
            return lost;
        case BusFault::frames_lost:
            return is_by_chance(random, 0.3) ? lost : arrives;
        case BusFault::frames_late:
            return {1, std::uniform_int_distribution<std::uint64_t>(0, latest_us)(random), frame};
        case BusFault::frames_twice:
            return {2, twice_after_us, frame};
        case BusFault::bytes_altered:
            return is_by_chance(random, 0.05) ? altered(frame, random) : arrives;
        case BusFault::babbling_drive:
            return is_from(frame, x_node) ? Fate{5, 0, frame} : arrives;
    }
    return arrives;
}

}  // namespace

const char* name_of(BusFault fault) {
    constexpr const char* names[] = {"spindle drive silent",
                                     "x drive silent",
                                     "program status silent",
                                     "override does not reach the CNC",
                                     "bus dead",
                                     "30 % of the frames lost",
                                     "frames up to 20 ms late",
                                     "frames twice",
                                     "5 % of the frames altered",
                                     "x drive babbles"};
    static_assert(std::size(names) == bus_faults);
    return names[static_cast<std::size_t>(fault)];
}

sim::LoopbackBus::Fault on_bus(BusFault fault, std::uint64_t seed) {
    return [fault, random = std::mt19937_64(seed)](const hal::CanFrame& frame) mutable {
        return fate_of(fault, frame, random);
    };
}

}  // namespace millforce::faults
