// SPDX-License-Identifier: Apache-2.0
#include "cia402/drive_node.hpp"

#include "cia402/objects.hpp"
#include "preparation.hpp"

namespace millforce::cia402 {

namespace {

constexpr std::uint64_t next_try_after_us = 500'000;
constexpr std::uint64_t next_try_after_refusal_us = 1'000'000;
constexpr float largest_rated_current_A = 10'000.0F;
constexpr float largest_rated_torque_Nm = 1'000'000.0F;

bool is_nmt_state(std::uint8_t byte) {
    const auto state = static_cast<NmtState>(byte);
    return state == NmtState::boot_up || state == NmtState::stopped || state == NmtState::operational ||
           state == NmtState::pre_operational;
}

}  // namespace

DriveNode::DriveNode(const DriveSettings& settings, const BusSettings& bus, bool is_spindle)
    : settings_(settings),
      is_master_(bus.is_master),
      is_spindle_(is_spindle),
      sync_period_us_(bus.sync_period_us),
      signals_(settings),
      sdo_(settings.node_id),
      rated_current_A_(settings.rated_current_A),
      rated_torque_Nm_(settings.rated_torque_Nm) {}

bool DriveNode::on_frame(const hal::CanFrame& frame, std::uint64_t time_us, RejectCounters& rejects) {
    for (std::size_t place = 0; place < settings_.pdos.size(); ++place) {
        if (settings_.pdos[place].is_used() && frame.id == settings_.pdos[place].id) {
            on_pdo(place, frame, time_us, rejects);
            return true;
        }
    }
    if (frame.id == cob_id::heartbeat + settings_.node_id) {
        on_heartbeat(frame, time_us, rejects);
        return true;
    }
    if (frame.id == cob_id::emergency + settings_.node_id) {
        on_emergency(frame, rejects);
        return true;
    }
    if (is_master_ && frame.id == cob_id::sdo_response + settings_.node_id) {
        sdo_.on_frame(frame, rejects);
        return true;
    }
    return false;
}

void DriveNode::on_pdo(std::size_t place, const hal::CanFrame& frame, std::uint64_t time_us, RejectCounters& rejects) {
    if (frame.length != length_bytes(settings_.pdos[place])) {
        rejects.add(Reject::pdo_length);
        return;
    }
    // Without heartbeats a PDO is the only sign: CiA 301 lets a drive send them in no other state.
    if (settings_.heartbeat_timeout_us == 0 && health_.state == NodeState::starting) {
        health_.state = NodeState::operational;
    }
    if (health_.state != NodeState::operational) {
        rejects.add(Reject::pdo_not_operational);
        return;
    }
    if (settings_.pdos[place].at_every_sync() && pdo_in_cycle_[place]) {
        rejects.add(Reject::pdo_repeated);
    }
    signals_.take(place, frame.data);
    pdo_time_us_[place] = time_us;
    pdo_received_[place] = true;
    pdo_in_cycle_[place] = true;
    health_.silent_cycles = 0;
    if (signals_.is_mapped(Signal::statusword) && signals_.pdo(Signal::statusword) == place) {
        health_.power = power_state(static_cast<std::uint16_t>(signals_.raw(Signal::statusword)));
    }
}

void DriveNode::on_heartbeat(const hal::CanFrame& frame, std::uint64_t time_us, RejectCounters& rejects) {
    if (frame.length != 1 || !is_nmt_state(frame.data[0])) {
        rejects.add(Reject::heartbeat_malformed);
        return;
    }
    heartbeat_us_ = time_us;
    const auto state = static_cast<NmtState>(frame.data[0]);
    if (state == NmtState::operational && health_.state == NodeState::starting) {
        health_.state = NodeState::operational;
        return;
    }
    const bool left_operational = health_.state == NodeState::operational && state != NmtState::operational;
    const bool restarted = state == NmtState::boot_up && polled_;
    if (left_operational || restarted || health_.state == NodeState::lost) {
        enter_start_of_life(time_us);
        if (!is_master_ && state == NmtState::operational) {
            health_.state = NodeState::operational;
        }
    }
}

void DriveNode::on_emergency(const hal::CanFrame& frame, RejectCounters& rejects) {
    if (!decode_emergency(frame, health_.emergency)) {
        rejects.add(Reject::emergency_malformed);
        return;
    }
    health_.emergency_active = emergency_class(health_.emergency.error_code) != EmergencyClass::error_reset;
}

/// A master prepares the drive from the first step on; a listener waits for it.
void DriveNode::enter_start_of_life(std::uint64_t time_us) {
    health_.state = is_master_ ? NodeState::preparing : NodeState::starting;
    health_.power = PowerState::unknown;
    pdo_received_ = {};
    has_last_count_ = false;
    has_index_ = false;
    index_number_ = 0;
    has_last_position_ = false;
    travel_check_ = {};
    health_.units_disagree = false;
    step_ = 0;
    sdo_.reset();
    next_try_us_ = time_us;
    nmt_to_send_ = is_master_ && settings_.write_mapping;
    nmt_command_ = NmtCommand::enter_pre_operational;
}

void DriveNode::poll(std::uint64_t time_us, RejectCounters& rejects) {
    if (settings_.node_id == 0) {
        return;
    }
    if (!polled_) {
        polled_ = true;
        heartbeat_us_ = time_us;
        enter_start_of_life(time_us);
    }
    const bool is_watched = settings_.heartbeat_timeout_us != 0 && health_.state == NodeState::operational;
    if (is_watched && time_us > heartbeat_us_ + settings_.heartbeat_timeout_us) {
        health_.state = NodeState::lost;
        health_.power = PowerState::unknown;
        health_.times_lost += health_.times_lost < UINT32_MAX ? 1U : 0U;
    }
    if (!is_master_) {
        return;
    }
    sdo_.poll(time_us);
    if (health_.state == NodeState::refused && time_us >= next_try_us_) {
        enter_start_of_life(time_us);
    }
    if (health_.state == NodeState::preparing) {
        prepare(time_us, rejects);
    } else if (health_.state == NodeState::starting && time_us >= next_try_us_) {
        send_start(time_us);
    }
}

void DriveNode::prepare(std::uint64_t time_us, RejectCounters& rejects) {
    switch (sdo_.state()) {
        case SdoState::pending:
            return;
        case SdoState::idle:
            break;
        case SdoState::silent:
            sdo_.reset();
            step_ = 0;
            next_try_us_ = time_us + next_try_after_us;
            break;
        case SdoState::aborted:
            refuse(time_us, sdo_.abort_code());
            return;
        case SdoState::done:
            if (!take_answer(rejects)) {
                refuse(time_us, 0);
                return;
            }
            sdo_.reset();
            ++step_;
            break;
    }
    if (time_us >= next_try_us_) {
        ask_or_start(time_us);
    }
}

void DriveNode::ask_or_start(std::uint64_t time_us) {
    SdoRequest request;
    if (preparation_step(settings_, step_, request)) {
        sdo_.ask(request, time_us);
        return;
    }
    health_.state = NodeState::starting;
    send_start(time_us);
}

void DriveNode::send_start(std::uint64_t time_us) {
    nmt_to_send_ = true;
    nmt_command_ = NmtCommand::start;
    next_try_us_ = time_us + next_try_after_us;
}

void DriveNode::refuse(std::uint64_t time_us, std::uint32_t abort_code) {
    health_.state = NodeState::refused;
    health_.sdo_abort_code = abort_code;
    next_try_us_ = time_us + next_try_after_refusal_us;
    sdo_.reset();
}

/// False where the drive names a rated value that no drive has.
bool DriveNode::take_answer(RejectCounters& rejects) {
    SdoRequest request;
    if (!preparation_step(settings_, step_, request) || request.bytes != 0) {
        return true;
    }
    const float value = static_cast<float>(sdo_.value()) * 0.001F;
    const bool is_torque = request.index == object::rated_torque_mNm;
    if (!(value > 0.0F) || value > (is_torque ? largest_rated_torque_Nm : largest_rated_current_A)) {
        rejects.add(Reject::sdo_value_range);
        return false;
    }
    (is_torque ? rated_torque_Nm_ : rated_current_A_) = value;
    return true;
}

bool DriveNode::take_frame(hal::CanFrame& frame) {
    if (nmt_to_send_) {
        nmt_to_send_ = false;
        frame = {};
        frame.id = cob_id::nmt;
        frame.length = 2;
        frame.data[0] = static_cast<std::uint8_t>(nmt_command_);
        frame.data[1] = settings_.node_id;
        return true;
    }
    return sdo_.take_frame(frame);
}

}  // namespace millforce::cia402
