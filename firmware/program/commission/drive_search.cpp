// SPDX-License-Identifier: Apache-2.0
#include "commission/drive_search.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cia402/sdo_client.hpp"

namespace millforce::host {

namespace {

constexpr std::uint32_t sdo_answer_id = 0x580;
constexpr std::uint8_t largest_node = 127;

class Search {
  public:
    explicit Search(const SearchBus& bus) : bus_(bus) {}

    std::vector<FoundDrive> all_nodes() {
        std::vector<cia402::SdoClient> clients;
        for (std::uint8_t node = 1; node <= largest_node; ++node) {
            clients.emplace_back(node);
            clients.back().ask({0x1000, 0, 0, 0}, bus_.now_us());
        }
        run(clients);
        std::vector<FoundDrive> found;
        for (std::uint8_t node = 1; node <= largest_node; ++node) {
            const cia402::SdoClient& client = clients[node - 1U];
            if (client.state() == cia402::SdoState::done) {
                found.emplace_back();
                found.back().node_id = node;
                found.back().device_type = client.value();
            }
        }
        return found;
    }

    std::optional<std::uint32_t> read(std::uint8_t node, std::uint16_t index, std::uint8_t subindex) {
        std::vector<cia402::SdoClient> one{cia402::SdoClient(node)};
        one[0].ask({index, subindex, 0, 0}, bus_.now_us());
        first_node_ = node;
        run(one);
        first_node_ = 1;
        return one[0].state() == cia402::SdoState::done ? std::optional(one[0].value()) : std::nullopt;
    }

  private:
    /// Until each has its answer, or was silent.
    void run(std::vector<cia402::SdoClient>& clients) {
        bool is_pending = true;
        while (is_pending) {
            hal::CanFrame frame;
            for (cia402::SdoClient& client : clients) {
                client.poll(bus_.now_us());
                while (client.take_frame(frame)) {
                    bus_.send(frame);
                }
            }
            while (const auto received = bus_.receive()) {
                hand_over(*received, clients);
            }
            is_pending = false;
            for (const cia402::SdoClient& client : clients) {
                is_pending = is_pending || client.state() == cia402::SdoState::pending;
            }
        }
    }

    void hand_over(const hal::CanFrame& frame, std::vector<cia402::SdoClient>& clients) {
        if (frame.extended || frame.remote || frame.id < sdo_answer_id + first_node_) {
            return;
        }
        const std::size_t place = frame.id - sdo_answer_id - first_node_;
        if (place < clients.size()) {
            clients[place].on_frame(frame, rejects_);
        }
    }

    const SearchBus& bus_;
    std::uint32_t first_node_ = 1;
    cia402::RejectCounters rejects_{};
};

std::optional<std::uint32_t> counts_per_turn(Search& search, std::uint8_t node) {
    const auto increments = search.read(node, 0x608F, 1);
    const auto turns = search.read(node, 0x608F, 2);
    return increments && turns && *turns > 0 ? std::optional(*increments / *turns) : std::nullopt;
}

void read_ratings(Search& search, FoundDrive& drive) {
    const std::uint8_t node = drive.node_id;
    drive.vendor_id = search.read(node, 0x1018, 1);
    drive.product_code = search.read(node, 0x1018, 2);
    drive.rated_current_mA = search.read(node, 0x6075, 0);
    drive.rated_torque_mNm = search.read(node, 0x6076, 0);
    drive.encoder_counts = counts_per_turn(search, node);
    drive.velocity_unit = search.read(node, 0x60A9, 0);
    drive.has_index_latch = search.read(node, 0x60BA, 0) && search.read(node, 0x60D5, 0);
}

}  // namespace

std::vector<FoundDrive> find_drives(const SearchBus& bus) {
    Search search(bus);
    std::vector<FoundDrive> found = search.all_nodes();
    for (FoundDrive& drive : found) {
        if (drive.is_cia402()) {
            read_ratings(search, drive);
        }
    }
    return found;
}

std::string FoundDrive::words() const {
    std::string text = fmt::format("node {}: ", node_id);
    if (!is_cia402()) {
        return text + fmt::format("device type 0x{:08X}, no drive", device_type);
    }
    text += "CiA 402 drive";
    if (vendor_id) {
        text += fmt::format(", vendor 0x{:X}", *vendor_id);
    }
    if (product_code) {
        text += fmt::format(", product 0x{:X}", *product_code);
    }
    if (rated_current_mA) {
        text += fmt::format(", rated {:g} A", 1e-3 * *rated_current_mA);
    }
    if (rated_torque_mNm) {
        text += fmt::format(" and {:g} N·m", 1e-3 * *rated_torque_mNm);
    }
    if (encoder_counts) {
        text += fmt::format(", {} counts per turn", *encoder_counts);
    }
    return text;
}

/// CiA 402-2 and CiA 303-2: prefix (a power of ten, signed), numerator, denominator, reserved; a byte each.
std::optional<double> FoundDrive::velocity_mm_s(double travel_per_turn_mm) const {
    constexpr unsigned metre = 0x01;
    constexpr unsigned second = 0x03;
    constexpr unsigned revolution = 0xB4;
    constexpr unsigned minute = 0x47;
    if (!velocity_unit) {
        return std::nullopt;
    }
    const auto power = static_cast<std::int8_t>(*velocity_unit >> 24U);
    const unsigned numerator = (*velocity_unit >> 16U) & 0xFFU;
    const unsigned denominator = (*velocity_unit >> 8U) & 0xFFU;
    const double length_mm = numerator == metre ? 1e3 : numerator == revolution ? travel_per_turn_mm : 0.0;
    const double time_s = denominator == second ? 1.0 : denominator == minute ? 60.0 : 0.0;
    if (!(length_mm > 0.0 && time_s > 0.0)) {
        return std::nullopt;
    }
    return length_mm / time_s * std::pow(10.0, power);
}

}  // namespace millforce::host
