// SPDX-License-Identifier: Apache-2.0
#include "bus/canopen_drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace millforce::sim {

namespace {

// Written from the standard on purpose, not taken from hal: a wrong number there must not agree with the one here.
constexpr std::uint32_t nmt_id = 0x000;
constexpr std::uint32_t sync_id = 0x080;
constexpr std::uint32_t emergency_id = 0x080;  // + node, as those below
constexpr std::uint32_t sdo_response_id = 0x580;
constexpr std::uint32_t sdo_request_id = 0x600;
constexpr std::uint32_t heartbeat_id = 0x700;
constexpr std::uint8_t state_boot_up = 0;
constexpr std::uint8_t state_stopped = 4;
constexpr std::uint8_t state_operational = 5;
constexpr std::uint8_t state_pre_operational = 127;
constexpr std::uint32_t pdo_invalid_bit = 0x8000'0000U;

constexpr std::uint32_t abort_command = 0x05040001;
constexpr std::uint32_t abort_read_only = 0x06010002;
constexpr std::uint32_t abort_no_object = 0x06020000;
constexpr std::uint32_t abort_not_mappable = 0x06040041;
constexpr std::uint32_t abort_pdo_length = 0x06040042;
constexpr std::uint32_t abort_length = 0x06070010;
constexpr std::uint32_t abort_no_subindex = 0x06090011;
constexpr std::uint32_t abort_value = 0x06090030;
constexpr std::uint32_t abort_device_state = 0x08000022;

std::uint32_t per_mille(double value, double rated) {
    const double share = rated > 0.0 ? std::clamp(std::round(1000.0 * value / rated), -32768.0, 32767.0) : 0.0;
    return static_cast<std::uint16_t>(static_cast<std::int16_t>(share));
}

std::uint8_t byte(std::uint32_t value, unsigned place) {
    return static_cast<std::uint8_t>(value >> (8U * place));
}

bool is_mapping_index(std::uint32_t index) {
    return index >= 0x1A00 && index <= 0x1A03;
}
bool is_communication_index(std::uint32_t index) {
    return index >= 0x1800 && index <= 0x1803;
}

}  // namespace

CanopenDrive::CanopenDrive(const CanopenDriveSettings& settings) : settings_(settings) {
    build_dictionary();
    boot();
}

void CanopenDrive::build_dictionary() {
    const std::unordered_map<Key, Entry> before = std::exchange(dictionary_, {});
    dictionary_[key(0x1000, 0)] = {0x00020192, 4, false, false};
    dictionary_[key(0x1001, 0)] = {0, 1, false, true};
    dictionary_[key(0x1017, 0)] = {settings_.heartbeat_ms, 2, true, false};
    dictionary_[key(0x1018, 0)] = {2, 1};
    dictionary_[key(0x1018, 1)] = {0, 4};  // no vendor: CAN in Automation assigns the numbers
    dictionary_[key(0x1018, 2)] = {1, 4};
    dictionary_[key(0x608F, 0)] = {2, 1};
    dictionary_[key(0x608F, 1)] = {settings_.encoder_counts_per_rev, 4};
    dictionary_[key(0x608F, 2)] = {1, 4};
    dictionary_[key(0x60A9, 0)] = {settings_.velocity_unit, 4};
    dictionary_[key(0x6075, 0)] = {static_cast<std::uint32_t>(std::lround(settings_.rated_current_A * 1e3)), 4};
    dictionary_[key(0x6076, 0)] = {static_cast<std::uint32_t>(std::lround(settings_.rated_torque_Nm * 1e3)), 4};
    dictionary_[key(0x6041, 0)] = {0x0237, 2, false, true};
    dictionary_[key(0x6064, 0)] = {0, 4, false, true};
    dictionary_[key(0x606C, 0)] = {0, 4, false, true};
    dictionary_[key(0x6077, 0)] = {0, 2, false, true};
    dictionary_[key(0x6078, 0)] = {0, 2, false, true};
    dictionary_[key(0x60BA, 0)] = {0, 4, false, true};
    dictionary_[key(0x60D5, 0)] = {0, 2, false, true};
    for (std::uint16_t pdo = 0; pdo < 4; ++pdo) {
        const auto communication = static_cast<std::uint16_t>(0x1800 + pdo);
        const auto mapping = static_cast<std::uint16_t>(0x1A00 + pdo);
        const std::uint32_t id = 0x180U + 0x100U * pdo + settings_.node_id;
        dictionary_[key(communication, 0)] = {2, 1};
        dictionary_[key(communication, 1)] = {pdo == 0 ? id : id | pdo_invalid_bit, 4, true};
        dictionary_[key(communication, 2)] = {1, 1, true};
        dictionary_[key(mapping, 0)] = {0, 1, true};
        for (std::uint8_t sub = 1; sub <= 8; ++sub) {
            dictionary_[key(mapping, sub)] = {0, 4, true};
        }
    }
    set(0x1A00, 0, static_cast<std::uint32_t>(settings_.first_pdo.size()));
    for (std::size_t k = 0; k < settings_.first_pdo.size(); ++k) {
        set(0x1A00, static_cast<std::uint8_t>(k + 1), settings_.first_pdo[k]);
    }
    // The motor has not moved.
    for (const auto& [where, entry] : before) {
        if (entry.mappable) {
            dictionary_[where].value = entry.value;
        }
    }
}

void CanopenDrive::set(std::uint16_t index, std::uint8_t subindex, std::uint32_t value) {
    dictionary_.at(key(index, subindex)).value = value;
}

std::uint32_t CanopenDrive::object(std::uint16_t index, std::uint8_t subindex) const {
    const auto found = dictionary_.find(key(index, subindex));
    return found == dictionary_.end() ? 0 : found->second.value;
}

void CanopenDrive::boot() {
    build_dictionary();
    nmt_state_ = state_pre_operational;
    syncs_since_pdo_ = {};
    next_heartbeat_us_ = time_us_;
    send(heartbeat_id + settings_.node_id, {state_boot_up});
}

void CanopenDrive::set_power(bool on) {
    outgoing_.clear();
    if (on && !powered_) {
        powered_ = true;
        boot();
    }
    powered_ = on;
}

void CanopenDrive::set_current_A(double current_A) {
    set(0x6078, 0, per_mille(current_A, settings_.rated_current_A));
}
void CanopenDrive::set_torque_Nm(double torque_Nm) {
    set(0x6077, 0, per_mille(torque_Nm, settings_.rated_torque_Nm));
}

void CanopenDrive::latch_index(std::int32_t position) {
    set(0x60BA, 0, static_cast<std::uint32_t>(position));
    set(0x60D5, 0, (object(0x60D5, 0) + 1U) & 0xFFFFU);
}

void CanopenDrive::raise_emergency(std::uint16_t error_code, std::uint8_t error_register) {
    set(0x1001, 0, error_register);
    send(emergency_id + settings_.node_id, {byte(error_code, 0), byte(error_code, 1), error_register, 0, 0, 0, 0, 0});
}

void CanopenDrive::on_frame(const hal::CanFrame& frame, std::uint64_t time_us) {
    time_us_ = time_us;
    if (!powered_ || frame.extended || frame.remote || frame.length > 8) {
        return;
    }
    if (frame.id == nmt_id && frame.length == 2) {
        on_nmt(frame);
    } else if (frame.id == sync_id && frame.length <= 1) {
        on_sync();
    } else if (frame.id == sdo_request_id + settings_.node_id && nmt_state_ != state_stopped) {
        on_sdo(frame);
    }
}

void CanopenDrive::poll(std::uint64_t time_us) {
    time_us_ = time_us;
    const std::uint64_t period_us = 1000ULL * object(0x1017, 0);
    if (!powered_ || period_us == 0 || time_us < next_heartbeat_us_) {
        return;
    }
    next_heartbeat_us_ = time_us + period_us;
    send(heartbeat_id + settings_.node_id, {nmt_state_});
}

std::vector<hal::CanFrame> CanopenDrive::take_frames() {
    return std::exchange(outgoing_, {});
}

void CanopenDrive::on_nmt(const hal::CanFrame& frame) {
    if (frame.data[1] != 0 && frame.data[1] != settings_.node_id) {
        return;
    }
    switch (frame.data[0]) {
        case 0x01:
            nmt_state_ = state_operational;
            break;
        case 0x02:
            nmt_state_ = state_stopped;
            break;
        case 0x80:
            nmt_state_ = state_pre_operational;
            break;
        case 0x81:
        case 0x82:
            boot();
            break;
        default:
            return;
    }
    next_heartbeat_us_ = time_us_;
}

void CanopenDrive::on_sync() {
    if (nmt_state_ != state_operational) {
        return;
    }
    for (unsigned pdo = 0; pdo < 4; ++pdo) {
        const auto communication = static_cast<std::uint16_t>(0x1800 + pdo);
        const std::uint32_t type = object(communication, 2);
        const bool is_cyclic = type >= 1 && type <= 240;
        const bool is_on = (object(communication, 1) & pdo_invalid_bit) == 0;
        if (is_on && is_cyclic && ++syncs_since_pdo_[pdo] >= type) {
            syncs_since_pdo_[pdo] = 0;
            send_pdo(pdo);
        }
    }
}

void CanopenDrive::send_pdo(unsigned number) {
    const auto mapping = static_cast<std::uint16_t>(0x1A00 + number);
    std::array<std::uint8_t, 8> data{};
    unsigned bit = 0;
    for (unsigned k = 1; k <= object(mapping, 0); ++k) {
        const std::uint32_t mapped = object(mapping, static_cast<std::uint8_t>(k));
        const std::uint32_t value = object(static_cast<std::uint16_t>(mapped >> 16U), byte(mapped, 1));
        for (unsigned b = 0; b < (mapped & 0xFFU) && bit < 64; ++b, ++bit) {
            const unsigned one = b < 32 ? (value >> b) & 1U : 0U;
            data[bit / 8] = static_cast<std::uint8_t>(data[bit / 8] | (one << (bit % 8)));
        }
    }
    const auto length = static_cast<std::ptrdiff_t>((bit + 7) / 8);
    send(object(static_cast<std::uint16_t>(0x1800 + number), 1) & 0x7FFU, {data.begin(), data.begin() + length});
}

void CanopenDrive::on_sdo(const hal::CanFrame& frame) {
    if (frame.length != 8) {
        return;
    }
    const Key where = key(static_cast<std::uint16_t>(frame.data[1] | (frame.data[2] << 8U)), frame.data[3]);
    const unsigned command = frame.data[0] >> 5U;
    if (command == 2) {
        answer_read(where);
    } else if (command == 1) {
        answer_write(where, frame);
    } else if (command != 4) {
        abort(where, abort_command);
    }
}

void CanopenDrive::answer_read(Key where) {
    const auto found = dictionary_.find(where);
    if (found == dictionary_.end()) {
        abort(where, dictionary_.contains(where & ~0xFFU) ? abort_no_subindex : abort_no_object);
        return;
    }
    const Entry& entry = found->second;
    const std::uint32_t v = entry.value;
    send(sdo_response_id + settings_.node_id,
         {static_cast<std::uint8_t>(0x43U | ((4U - entry.bytes) << 2U)), byte(where, 1), byte(where, 2), byte(where, 0),
          byte(v, 0), byte(v, 1), byte(v, 2), byte(v, 3)});
}

void CanopenDrive::answer_write(Key where, const hal::CanFrame& frame) {
    const auto found = dictionary_.find(where);
    if (found == dictionary_.end()) {
        abort(where, dictionary_.contains(where & ~0xFFU) ? abort_no_subindex : abort_no_object);
        return;
    }
    Entry& entry = found->second;
    if ((frame.data[0] & 0x02U) == 0) {
        abort(where, abort_command);
        return;
    }
    const unsigned bytes = (frame.data[0] & 0x01U) != 0 ? 4U - ((frame.data[0] >> 2U) & 3U) : entry.bytes;
    std::uint32_t value = 0;
    for (unsigned k = 0; k < bytes; ++k) {
        value |= std::uint32_t{frame.data[4 + k]} << (8U * k);
    }
    std::uint32_t code = refusal_of_write(where, entry, value);
    code = code == 0 && bytes != entry.bytes ? abort_length : code;
    if (code != 0) {
        abort(where, code);
        return;
    }
    entry.value = value;
    send(sdo_response_id + settings_.node_id, {0x60, frame.data[1], frame.data[2], frame.data[3], 0, 0, 0, 0});
}

std::uint32_t CanopenDrive::refusal_of_write(Key where, const Entry& entry, std::uint32_t value) const {
    if (!entry.writable) {
        return abort_read_only;
    }
    const std::uint32_t index = where >> 8U;
    const bool is_pdo = is_mapping_index(index) || is_communication_index(index);
    if (is_pdo && nmt_state_ == state_operational) {
        return abort_device_state;
    }
    if (is_communication_index(index) && (where & 0xFFU) == 2 && value > 240 && value < 254) {
        return abort_value;
    }
    return is_mapping_index(index) ? refusal_of_mapping(where, value) : 0;
}

/// CiA 301: only while the PDO is off; objects only while their number is 0; the number only if all of them fit.
std::uint32_t CanopenDrive::refusal_of_mapping(Key where, std::uint32_t value) const {
    const auto mapping = static_cast<std::uint16_t>(where >> 8U);
    const auto communication = static_cast<std::uint16_t>(mapping - 0x200U);
    if ((object(communication, 1) & pdo_invalid_bit) == 0) {
        return abort_device_state;
    }
    const auto subindex = static_cast<std::uint8_t>(where);
    if (subindex != 0) {
        if (object(mapping, 0) != 0) {
            return abort_device_state;
        }
        const auto target = dictionary_.find(value >> 8U);
        const bool is_mappable = target != dictionary_.end() && target->second.mappable;
        return is_mappable && (value & 0xFFU) == 8U * target->second.bytes ? 0 : abort_not_mappable;
    }
    if (value > 8) {
        return abort_value;
    }
    unsigned bits = 0;
    for (unsigned k = 1; k <= value; ++k) {
        bits += object(mapping, static_cast<std::uint8_t>(k)) & 0xFFU;
    }
    return bits > 64 ? abort_pdo_length : 0;
}

void CanopenDrive::abort(Key where, std::uint32_t code) {
    ++aborts_;
    send(sdo_response_id + settings_.node_id, {0x80, byte(where, 1), byte(where, 2), byte(where, 0), byte(code, 0),
                                               byte(code, 1), byte(code, 2), byte(code, 3)});
}

void CanopenDrive::send(std::uint32_t id, std::vector<std::uint8_t> bytes) {
    if (!powered_) {
        return;
    }
    hal::CanFrame frame;
    frame.id = id;
    frame.length = static_cast<std::uint8_t>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), frame.data.begin());
    outgoing_.push_back(frame);
}

}  // namespace millforce::sim
