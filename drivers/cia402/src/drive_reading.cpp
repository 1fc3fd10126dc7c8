// SPDX-License-Identifier: Apache-2.0
#include "cia402/drive_node.hpp"
#include "cia402/magnitude.hpp"

/// From raw values of a SYNC period to amperes, millimetres per second and counts.

namespace millforce::cia402 {

namespace {

constexpr float rms_per_peak = 0.70710678F;
/// A difference of positions over more than this many SYNC periods is no speed any more.
constexpr float longest_gap_periods = 4.0F;

/// The shortest way from one place to the other on a circle of `modulus` counts (0: 2^32).
std::int64_t shortest_step(std::uint32_t from, std::uint32_t to, std::uint64_t modulus) {
    const auto m = static_cast<std::int64_t>(modulus);
    std::int64_t step = (static_cast<std::int64_t>(to) - static_cast<std::int64_t>(from)) % m;
    if (step < 0) {
        step += m;
    }
    return step > m / 2 ? step - m : step;
}

std::uint64_t modulus_of(std::uint32_t configured, unsigned bits) {
    return configured != 0 ? configured : std::uint64_t{1} << (bits < 32 ? bits : 32U);
}

}  // namespace

void DriveNode::begin_cycle() {
    pdo_in_cycle_ = {};
}

void DriveNode::end_cycle() {
    bool any = false;
    for (const bool received : pdo_in_cycle_) {
        any = any || received;
    }
    if (!any && health_.silent_cycles < UINT32_MAX) {
        ++health_.silent_cycles;
    }
}

bool DriveNode::is_complete() const {
    if (health_.state != NodeState::operational) {
        return true;
    }
    for (std::size_t k = 0; k < settings_.pdos.size(); ++k) {
        const PdoMapping& pdo = settings_.pdos[k];
        if (pdo.is_used() && pdo.at_every_sync() && !pdo_in_cycle_[k]) {
            return false;
        }
    }
    return true;
}

bool DriveNode::is_fresh(Signal signal, std::uint64_t now_us) const {
    if (!signals_.is_mapped(signal)) {
        return false;
    }
    const std::size_t pdo = signals_.pdo(signal);
    if (settings_.pdos[pdo].at_every_sync()) {
        return pdo_in_cycle_[pdo];
    }
    return pdo_received_[pdo] && now_us <= pdo_time_us_[pdo] + settings_.stale_us;
}

DriveReading DriveNode::read(std::uint64_t sync_time_us, RejectCounters& rejects) {
    DriveReading reading;
    if (health_.state != NodeState::operational) {
        return reading;
    }
    if (settings_.gives_current) {
        read_current(sync_time_us, reading, rejects);
    }
    if (!settings_.gives_motion) {
        return reading;
    }
    if (is_spindle_) {
        read_count(sync_time_us, reading, rejects);
    } else {
        read_velocity(sync_time_us, reading, rejects);
    }
    return reading;
}

void DriveNode::read_current(std::uint64_t now_us, DriveReading& reading, RejectCounters& rejects) const {
    const bool by_torque = settings_.current_source == CurrentSource::torque;
    const Signal signal = by_torque ? Signal::torque : Signal::current;
    if (!is_fresh(signal, now_us)) {
        return;
    }
    const float share = static_cast<float>(signals_.signed_value(signal)) * 0.001F;
    if (!(magnitude(share) <= settings_.largest_share_of_rated)) {
        rejects.add(Reject::current_range);
        return;
    }
    const float rated_A = by_torque ? rated_torque_Nm_ / settings_.torque_constant_Nm_per_A : rated_current_A_;
    const float rms_A = share * rated_A * (settings_.current_basis == CurrentBasis::peak ? rms_per_peak : 1.0F);
    reading.current_A = settings_.current_reversed ? -rms_A : rms_A;
    reading.has_current = true;
}

float DriveNode::periods_since(std::uint64_t before_us, std::uint64_t now_us) const {
    if (now_us <= before_us) {
        return 0.0F;
    }
    // Jitter of the SYNC's time stamp is no change of speed: whole periods, as the drives see them.
    const std::uint64_t periods = (now_us - before_us + sync_period_us_ / 2) / sync_period_us_;
    return static_cast<float>(periods);
}

void DriveNode::read_count(std::uint64_t now_us, DriveReading& reading, RejectCounters& rejects) {
    if (!is_fresh(Signal::count, now_us)) {
        return;
    }
    const std::uint32_t raw = signals_.raw(Signal::count);
    const std::uint64_t modulus = modulus_of(settings_.count_modulus, signals_.bits(Signal::count));
    const bool is_first = !has_last_count_;
    const std::int64_t step = is_first ? 0 : shortest_step(last_raw_count_, raw, modulus);
    const float periods = periods_since(last_count_us_, now_us);
    const bool is_possible =
        raw < modulus && static_cast<float>(step < 0 ? -step : step) <=
                             static_cast<float>(settings_.largest_count_step) * (periods > 1.0F ? periods : 1.0F);
    if (is_first) {
        count_ = settings_.count_reversed ? static_cast<std::uint32_t>(-static_cast<std::int64_t>(raw)) : raw;
    } else {
        count_ += static_cast<std::uint32_t>(settings_.count_reversed ? -step : step);
    }
    has_last_count_ = true;
    last_raw_count_ = raw;
    last_count_us_ = now_us;
    if (!is_possible) {
        index_number_ = 0;  // the drive may count from elsewhere now: the index is not known until its next pulse
        rejects.add(Reject::position_step);
        return;
    }
    reading.has_count = true;
    reading.count = count_;
    read_index(now_us, raw, reading);
}

/// A new pulse was at most a period ago, so the way since then is short. One that was there before the drive was first
/// read may be turns ago: then a modulus of whole revolutions gives its angle all the same.
void DriveNode::read_index(std::uint64_t now_us, std::uint32_t raw_count, DriveReading& reading) {
    if (is_fresh(Signal::index_count, now_us) && is_fresh(Signal::index_number, now_us)) {
        const std::uint32_t raw_number = signals_.raw(Signal::index_number);
        const bool is_new = has_index_ ? raw_number != last_raw_index_number_ : raw_number != 0;
        has_index_ = true;
        last_raw_index_number_ = raw_number;
        if (is_new) {
            const std::uint64_t modulus = modulus_of(settings_.count_modulus, signals_.bits(Signal::count));
            const std::int64_t since = shortest_step(signals_.raw(Signal::index_count), raw_count, modulus);
            index_count_ = count_ - static_cast<std::uint32_t>(settings_.count_reversed ? -since : since);
            index_number_ = static_cast<std::uint8_t>(index_number_ == UINT8_MAX ? 1 : index_number_ + 1);
        }
    }
    reading.index_count = index_count_;
    reading.index_number = index_number_;
}

/// The distance from the previous position, if there is one.
bool DriveNode::moved_mm(std::uint64_t now_us, float& way_mm, float& elapsed_s) {
    if (settings_.position_mm_per_unit == 0.0F || !is_fresh(Signal::position, now_us)) {
        return false;
    }
    const std::uint32_t raw = signals_.raw(Signal::position);
    const float periods = periods_since(last_position_us_, now_us);
    const bool is_usable = has_last_position_ && periods > 0.0F && periods <= longest_gap_periods;
    const std::int64_t step = shortest_step(last_position_, raw, modulus_of(0, signals_.bits(Signal::position)));
    has_last_position_ = true;
    last_position_ = raw;
    last_position_us_ = now_us;
    way_mm = static_cast<float>(step) * settings_.position_mm_per_unit;
    elapsed_s = periods * static_cast<float>(sync_period_us_) * 1e-6F;
    return is_usable;
}

void DriveNode::read_velocity(std::uint64_t now_us, DriveReading& reading, RejectCounters& rejects) {
    float way_mm = 0.0F;
    float elapsed_s = 0.0F;
    const bool has_way = moved_mm(now_us, way_mm, elapsed_s);
    const bool by_position = settings_.velocity_source == VelocitySource::position;
    if (by_position ? !has_way : !is_fresh(Signal::velocity, now_us)) {
        return;
    }
    const float velocity_mm_s =
        by_position ? way_mm / elapsed_s
                    : static_cast<float>(signals_.signed_value(Signal::velocity)) * settings_.velocity_mm_s_per_unit;
    if (!(magnitude(velocity_mm_s) <= settings_.largest_velocity_mm_s)) {
        rejects.add(by_position ? Reject::position_step : Reject::velocity_range);
        return;
    }
    if (has_way && !by_position) {
        travel_check_.add(velocity_mm_s, way_mm, elapsed_s);
        health_.units_disagree = travel_check_.disagrees();
    }
    if (health_.units_disagree) {
        rejects.add(Reject::units_disagree);
        return;
    }
    reading.velocity_mm_s = velocity_mm_s;
    reading.has_velocity = true;
}

}  // namespace millforce::cia402
