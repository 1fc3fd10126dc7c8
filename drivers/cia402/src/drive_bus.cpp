// SPDX-License-Identifier: Apache-2.0
#include "cia402/drive_bus.hpp"

#include <algorithm>

#include "cia402/objects.hpp"

namespace millforce::cia402 {

namespace {

constexpr std::uint64_t sync_lost_after_periods = 3;

std::size_t add_filter(std::span<hal::CanFilter, DriveBus::filter_capacity> filters, std::size_t count,
                       std::uint32_t id) {
    filters[count] = {id, hal::largest_standard_can_id};
    return count + 1;
}

std::uint8_t complete_sample(const BusSettings& settings) {
    unsigned present = settings.beside_bus;
    for (std::size_t role = 0; role < drive_capacity; ++role) {
        const unsigned of_spindle = hal::mask(hal::Present::spindle_count) | hal::mask(hal::Present::spindle_current);
        const unsigned of_role = role == 0 ? of_spindle : hal::axis_mask(role - 1);
        present |= settings.drives[role].node_id != 0 ? of_role : 0U;
    }
    return static_cast<std::uint8_t>(present);
}

}  // namespace

DriveBus::DriveBus(const BusSettings& settings)
    : settings_(settings), complete_(complete_sample(settings)), sync_clock_(settings.sync_period_us) {
    health_.sync_lost = true;
    if (check(settings) != SettingsError::none) {
        settings_ = {};
        return;
    }
    for (std::size_t k = 0; k < drive_capacity; ++k) {
        if (settings.drives[k].node_id != 0) {
            nodes_[k] = DriveNode(settings.drives[k], settings, k == static_cast<std::size_t>(DriveRole::spindle));
        }
    }
}

void DriveBus::on_frame(const hal::CanFrame& frame, std::uint64_t time_us) {
    if (frame.length > hal::largest_can_length) {
        rejects_.add(Reject::frame_length);
        return;
    }
    if (frame.extended || frame.remote || frame.id > hal::largest_standard_can_id) {
        rejects_.add(Reject::not_standard_data);
        return;
    }
    if (frame.id == settings_.sync_id) {
        on_sync(frame, time_us);
        return;
    }
    for (std::size_t k = 0; k < drive_capacity; ++k) {
        if (nodes_[k].node_id() == 0) {
            continue;
        }
        // What arrives after the sample was handed over belongs to no sample: it would be taken for the next one's.
        const bool is_synchronous = is_sync_pdo(k, frame.id);
        if (is_synchronous && !cycle_open_ && nodes_[k].health().state == NodeState::operational) {
            rejects_.add(Reject::pdo_late);
            an_answer_is_late_ = true;
            return;
        }
        if (nodes_[k].on_frame(frame, time_us, rejects_)) {
            hand_over_when_complete();
            return;
        }
    }
    rejects_.add(Reject::foreign_id);
}

void DriveBus::on_sync(const hal::CanFrame& frame, std::uint64_t time_us) {
    if (frame.length > 1) {
        rejects_.add(Reject::sync_length);
        return;
    }
    if (had_sync_ && time_us < sync_time_us_ + settings_.sync_period_us / 2) {
        rejects_.add(Reject::sync_early);
        return;
    }
    begin_cycle(time_us);
}

void DriveBus::begin_cycle(std::uint64_t time_us) {
    if (cycle_open_) {
        hand_over();
    }
    for (DriveNode& node : nodes_) {
        node.begin_cycle();
    }
    may_be_answers_to_last_ = an_answer_is_late_;
    an_answer_is_late_ = false;
    has_beside_bus_ = false;
    sync_time_us_ = time_us;
    sync_clock_.on_sync(time_us);
    had_sync_ = true;
    cycle_open_ = true;
    health_.sync_lost = false;
    ++health_.syncs;
}

bool DriveBus::is_complete() const {
    if (settings_.beside_bus != 0 && !has_beside_bus_) {
        return false;
    }
    const auto is_operational = [](const DriveNode& node) { return node.health().state == NodeState::operational; };
    return have_all_answered() && (has_beside_bus_ || std::any_of(nodes_.begin(), nodes_.end(), is_operational));
}

bool DriveBus::have_all_answered() const {
    return std::all_of(nodes_.begin(), nodes_.end(), [](const DriveNode& node) { return node.is_complete(); });
}

void DriveBus::add(const hal::DriveSample& beside_bus) {
    if (!cycle_open_) {
        return;
    }
    beside_bus_ = beside_bus;
    has_beside_bus_ = true;
    hand_over_when_complete();
}

void DriveBus::hand_over_when_complete() {
    if (may_end_before_next_sync() && is_complete()) {
        hand_over();
    }
}

void DriveBus::hand_over() {
    an_answer_is_late_ = !have_all_answered();
    health_.samples_incomplete += is_complete() ? 0U : 1U;
    health_.samples_untaken += sample_ready_ ? 1U : 0U;
    sample_ = {};
    for (std::size_t k = 0; k < drive_capacity; ++k) {
        const DriveReading reading = nodes_[k].read(sync_time_us_, rejects_);
        nodes_[k].end_cycle();
        put(k, reading);
    }
    if (has_beside_bus_) {
        hal::add(sample_, beside_bus_);
    }
    if ((sample_.present & hal::mask(hal::Present::spindle_count)) != 0) {
        sync_clock_.on_count(sample_.spindle_count);
    }
    sample_.time_us = static_cast<std::uint32_t>(sync_clock_.latched_us());
    sample_ready_ = true;
    had_sample_ = true;
    cycle_open_ = false;
}

void DriveBus::put(std::size_t role, const DriveReading& reading) {
    if (role != static_cast<std::size_t>(DriveRole::spindle)) {
        const std::size_t axis = role - 1;
        sample_.axis_current_A[axis] = reading.current_A;
        sample_.axis_velocity_mm_s[axis] = reading.velocity_mm_s;
        hal::set_known(sample_, axis, reading.has_current, reading.has_velocity);
        return;
    }
    sample_.spindle_current_A = reading.current_A;
    sample_.spindle_count = reading.count;
    sample_.spindle_index_count = reading.index_count;
    sample_.spindle_index_number = reading.index_number;
    if (reading.has_current) {
        hal::set_present(sample_, hal::Present::spindle_current);
    }
    if (reading.has_count) {
        hal::set_present(sample_, hal::Present::spindle_count);
    }
}

void DriveBus::poll(std::uint64_t time_us) {
    for (DriveNode& node : nodes_) {
        node.poll(time_us, rejects_);
    }
    if (may_end_before_next_sync() && time_us >= sync_time_us_ + settings_.collect_us) {
        hand_over();
    }
    const std::uint64_t patience_us = sync_lost_after_periods * settings_.sync_period_us;
    health_.sync_lost = !had_sync_ || time_us > sync_time_us_ + patience_us;
}

bool DriveBus::take_frame(hal::CanFrame& frame) {
    for (DriveNode& node : nodes_) {
        if (node.node_id() != 0 && node.take_frame(frame)) {
            return true;
        }
    }
    return false;
}

bool DriveBus::take_sample(hal::DriveSample& sample) {
    if (!sample_ready_) {
        return false;
    }
    sample = sample_;
    sample_ready_ = false;
    return true;
}

hal::SourceState DriveBus::state() const {
    if (!had_sample_) {
        return hal::SourceState::waiting;
    }
    return health_.sync_lost ? hal::SourceState::silent : hal::SourceState::running;
}

std::uint64_t DriveBus::next_event_us(std::uint64_t now_us) const {
    std::uint64_t next_us = now_us + settings_.sync_period_us;
    if (may_end_before_next_sync() && sync_time_us_ + settings_.collect_us < next_us) {
        next_us = sync_time_us_ + settings_.collect_us;
    }
    return next_us > now_us ? next_us : now_us;
}

bool DriveBus::is_sync_pdo(std::size_t role, std::uint32_t id) const {
    for (const PdoMapping& pdo : settings_.drives[role].pdos) {
        if (pdo.is_used() && pdo.id == id) {
            return pdo.at_every_sync();
        }
    }
    return false;
}

std::size_t DriveBus::filters(std::span<hal::CanFilter, filter_capacity> filters) const {
    std::size_t count = add_filter(filters, 0, settings_.sync_id);
    for (const DriveSettings& drive : settings_.drives) {
        if (drive.node_id == 0) {
            continue;
        }
        for (const PdoMapping& pdo : drive.pdos) {
            count = pdo.is_used() ? add_filter(filters, count, pdo.id) : count;
        }
        count = add_filter(filters, count, cob_id::heartbeat + drive.node_id);
        count = add_filter(filters, count, cob_id::emergency + drive.node_id);
        if (settings_.is_master) {
            count = add_filter(filters, count, cob_id::sdo_response + drive.node_id);
        }
    }
    return count;
}

const NodeHealth& DriveBus::health(DriveRole role) const {
    return nodes_[static_cast<std::size_t>(role)].health();
}

}  // namespace millforce::cia402
