// SPDX-License-Identifier: Apache-2.0
#include "firmware_can/can_controller.hpp"

#include <algorithm>
#include <array>
#include <memory>

#include "cia402/objects.hpp"
#include "firmware/path_speed.hpp"

namespace millforce::firmware {

namespace {

std::uint32_t own_heartbeat_id(const CanControllerSettings& settings) {
    return cia402::cob_id::heartbeat + settings.feed_override.node_id;
}

/// Where no tool can be chosen its frame is not heard, so that it does not pass time either.
std::uint32_t tool_id(const CanControllerSettings& settings, const ToolSource* tools) {
    return tools != nullptr ? program_status::tool_frame_id(settings.program.id) : 0;
}

/// Nor is the position where nobody looks ahead.
std::uint32_t position_id(const CanControllerSettings& settings, const WaySource<float>* way) {
    return way != nullptr ? program_status::position_frame_id(settings.program.id) : 0;
}

std::uint32_t way_id(const WaySource<float>* way) {
    return way != nullptr ? way->frame_id() : 0;
}

std::uint64_t microseconds(float seconds) {
    return static_cast<std::uint64_t>(seconds * 1e6F);
}

float seconds(std::uint64_t microseconds) {
    return static_cast<float>(microseconds) * 1e-6F;
}

/// SYNC periods without a sample after which the tick runs without one.
constexpr std::uint64_t silent_after_periods = 5;
/// The fault has long been latched then: a log with a gap of hours is not ticked through.
constexpr std::uint64_t longest_silence_us = 10'000'000;
constexpr std::uint64_t boot_up_period_us = 200'000;
constexpr std::uint64_t shown_for_us = 1'000'000;

}  // namespace

CanController::CanController(const CanControllerSettings& settings, const Parameters<float>& parameters,
                             TickListener* listener, const ToolSource* tools, WaySource<float>* way)
    : settings_(settings),
      parameters_(parameters),
      tools_(tools),
      way_(way),
      is_running_(settings.begins_at_once),
      stale_us_(microseconds(parameters.machine.cnc.stale_s)),
      silent_after_us_(silent_after_periods * settings.drives.sync_period_us),
      bus_(settings.drives),
      sync_(settings.drives.sync_id, settings.drives.sync_period_us),
      program_receiver_(settings.program),
      tool_receiver_(tool_id(settings, tools)),
      speed_receiver_(program_status::speed_frame_id(settings.program.id)),
      position_receiver_(position_id(settings, way)),
      sender_(settings.feed_override),
      tick_(parameters, tools),
      listener_(listener) {
    std::array<hal::CanFilter, filter_capacity> used{};
    const std::size_t count = filters(used);
    for (std::size_t k = 0; k < count; ++k) {
        used_ids_.set(used[k].id & hal::largest_standard_can_id);
    }
}

/// Everything that frames changed is forgotten: a replay knows nothing from before the boot-up.
void CanController::begin() {
    is_running_ = true;
    // In their places: some kB each would not fit the stack of a small processor.
    std::destroy_at(&bus_);
    std::construct_at(&bus_, settings_.drives);
    program_receiver_ = program_status::ProgramStatusReceiver(settings_.program);
    tool_receiver_ = program_status::ToolReceiver(tool_id(settings_, tools_));
    speed_receiver_ = program_status::SpeedReceiver(program_status::speed_frame_id(settings_.program.id));
    position_receiver_ = program_status::PositionReceiver(position_id(settings_, way_));
    if (has_begun_) {
        std::destroy_at(&tick_);
        std::construct_at(&tick_, parameters_, tools_);
    }
    if (way_ != nullptr) {
        way_->begin_again();
    }
    bus_time_us_ = 0;
    has_begun_ = false;
    sample_ = {};
    program_ = {};
}

bool CanController::is_used(const hal::CanFrame& frame) const {
    return !frame.extended && !frame.remote && frame.id <= hal::largest_standard_can_id && used_ids_.test(frame.id);
}

void CanController::advance_to(std::uint64_t time_us) {
    bus_time_us_ = std::max(bus_time_us_, time_us);
    bus_.poll(bus_time_us_);
    run_ticks();
}

void CanController::on_frame(const hal::CanFrame& frame, std::uint64_t time_us, bool is_own) {
    if (!is_used(frame)) {
        if (!is_own) {
            bus_.on_frame(frame, time_us);  // counts it as rejected, and does no more
        }
        return;
    }
    was_heard_ = true;
    if (is_own && override_frame::is_boot_up(frame, settings_.feed_override.node_id)) {
        begin();
    }
    if (!is_running_) {
        return;
    }
    advance_to(time_us);
    const bool is_sync = frame.id == settings_.drives.sync_id;
    if (is_sync && settings_.produces_sync && !is_own) {
        foreign_syncs_ += foreign_syncs_ < UINT32_MAX ? 1U : 0U;
        foreign_sync_us_ = time_us;
        return;
    }
    if (is_own_output(frame)) {
        if (!is_own) {
            is_override_foreign_ = true;
            foreign_override_us_ = time_us;
        }
        return;  // of what the tick sees, they only show that time has passed
    }
    program_receiver_.on_frame(frame, time_us);
    tool_receiver_.on_frame(frame, time_us);
    speed_receiver_.on_frame(frame, time_us);
    position_receiver_.on_frame(frame, time_us);
    if (way_ != nullptr && frame.id == way_->frame_id()) {
        way_->on_frame(frame);
    }
    bus_.on_frame(frame, time_us);
    run_ticks();
}

void CanController::add(const hal::DriveSample& beside_bus) {
    if (is_running_) {
        bus_.add(beside_bus);
        run_ticks();
    }
}

bool CanController::is_own_output(const hal::CanFrame& frame) const {
    return frame.id == settings_.feed_override.id || frame.id == own_heartbeat_id(settings_);
}

bool CanController::has_complete_sample() const {
    return (sample_.present & bus_.complete()) == bus_.complete();
}

void CanController::poll(std::uint64_t now_us) {
    if (settings_.produces_sync && is_running_ && !stopped_) {
        sync_.poll(now_us);
    }
    watch_silence(now_us);
    is_override_foreign_ = is_override_foreign_ && now_us < foreign_override_us_ + shown_for_us;
    sender_.poll(now_us);
    repeat_boot_up(now_us);
    judge(now_us);
}

void CanController::watch_silence(std::uint64_t now_us) {
    if (was_heard_ || heard_us_ == 0) {
        was_heard_ = false;
        heard_us_ = now_us;
    }
    is_silent_ = now_us > heard_us_ + stale_us_;
    if (is_silent_ && has_begun_) {
        sender_.update(sent_override(), now_us);
    }
}

hal::FeedOverride CanController::sent_override() const {
    hal::FeedOverride sent = output_;
    sent.hold = sent.hold || is_silent_ || is_held_outside_ || is_override_foreign_;
    return sent;
}

/// Until it comes back: the first may have gone to an interface that was not there.
void CanController::repeat_boot_up(std::uint64_t now_us) {
    if (is_running_ || now_us < next_boot_up_us_) {
        return;
    }
    if (next_boot_up_us_ != 0) {
        sender_.boot_up_again();
    }
    next_boot_up_us_ = now_us + boot_up_period_us;
}

void CanController::run_ticks() {
    if (stopped_) {
        return;
    }
    if (hal::DriveSample sample; bus_.take_sample(sample)) {
        sample_ = sample;
        // The sample's time has 32 bits: the nearest such time to now. Where the stamp was early it may be ahead.
        const auto age_us = static_cast<std::int32_t>(static_cast<std::uint32_t>(bus_time_us_) - sample.time_us);
        sync_time_us_ = bus_time_us_ - static_cast<std::uint64_t>(static_cast<std::int64_t>(age_us));
        tick_on_sample();
    }
    if (has_begun_ && bus_time_us_ > next_silent_us_ + longest_silence_us) {
        next_silent_us_ = bus_time_us_ - longest_silence_us;
    }
    while (has_begun_ && bus_time_us_ >= next_silent_us_) {
        tick_without_sample();
    }
}

/// A sample that lacks something is left out: the next complete one spans its time.
void CanController::tick_on_sample() {
    if (!has_complete_sample()) {
        return;
    }
    has_begun_ = true;
    complete_time_us_ = sync_time_us_;
    next_silent_us_ = sync_time_us_ + silent_after_us_;
    program_ = program_at(sync_time_us_);
    reset_fault_where_asked();
    finish_work(tick_);  // what was not done in time: a replay does the same work
    if (tick_.follow_tool(tool_receiver_.number(sync_time_us_), is_at_rest()) && way_ != nullptr) {
        way_->set_tool(tick_.tool());
    }
    tick_.take(sample_);
    finish_estimate(tick_);
    if (way_ != nullptr && tick_.is_tool_known()) {
        way_->look_ahead(tick_.of_tool(), program_);
    }
    finish(tick_.answer(program_), sync_time_us_);
}

void CanController::tick_without_sample() {
    const std::uint64_t time_us = next_silent_us_;
    next_silent_us_ += settings_.drives.sync_period_us;
    program_ = program_at(time_us);
    finish(tick_.step_without_sample(seconds(time_us - complete_time_us_), seconds(settings_.drives.sync_period_us),
                                     program_),
           time_us);
}

void CanController::finish(const hal::FeedOverride& output, std::uint64_t time_us) {
    output_ = output;
    tick_time_us_ = time_us;
    sender_.update(sent_override(), bus_time_us_);
    if (listener_ != nullptr) {
        listener_->on_tick(*this);
    }
}

void CanController::stop(std::uint64_t now_us) {
    stopped_ = true;
    output_.hold = true;
    if (has_begun_) {
        sender_.update(output_, now_us);
    }
}

hal::ProgramStatus CanController::program_at(std::uint64_t time_us) const {
    hal::ProgramStatus program = program_receiver_.program(time_us);
    program.feed_hold = program.feed_hold || is_any_drive_stopped();
    const program_status::ProgramPosition position = position_receiver_.position(time_us, path_speed_mm_s(sample_));
    program.line = position.line;
    program.distance_to_go_mm = position.distance_to_go_mm;
    program.commanded_speed_rad_s = speed_receiver_.speed_rad_s(time_us);
    return program;
}

/// The CNC brakes by itself then; the override must neither rise meanwhile nor jump when the drive comes back.
bool CanController::is_any_drive_stopped() const {
    for (std::size_t role = 0; role < cia402::drive_capacity; ++role) {
        const cia402::PowerState power = bus_.health(static_cast<cia402::DriveRole>(role)).power;
        if (cia402::is_faulted(power) || power == cia402::PowerState::quick_stop_active) {
            return true;
        }
    }
    return false;
}

void CanController::reset_fault_where_asked() {
    if (program_receiver_.take_reset() && has_complete_sample() && tick_.may_reset(sample_.axis_velocity_mm_s)) {
        tick_.reset_fault();
    }
}

bool CanController::is_at_rest() const {
    return has_complete_sample() && hal::axes_rest(sample_.axis_velocity_mm_s);
}

void CanController::judge(std::uint64_t now_us) {
    using cia402::NodeState;
    Conditions found;
    found.set(Condition::sync_lost, bus_.health().sync_lost || is_silent_);
    found.set(Condition::sync_foreign, foreign_syncs_ > 0 && now_us < foreign_sync_us_ + shown_for_us);
    for (std::size_t role = 0; role < cia402::drive_capacity; ++role) {
        const cia402::NodeHealth& drive = bus_.health(static_cast<cia402::DriveRole>(role));
        Conditions of_drive;
        of_drive.set(Condition::drive_preparing,
                     drive.state == NodeState::preparing || drive.state == NodeState::starting);
        of_drive.set(Condition::drive_refused, drive.state == NodeState::refused);
        of_drive.set(Condition::drive_lost, drive.state == NodeState::lost);
        of_drive.set(Condition::drive_emergency, drive.emergency_active);
        of_drive.set(Condition::drive_units_disagree, drive.units_disagree);
        found.add(of_drive);
    }
    found.set(Condition::drive_not_enabled, is_any_drive_stopped());
    found.set(Condition::input_incomplete, !has_complete_sample());
    found.set(Condition::input_stale, has_begun_ && (is_silent_ || bus_time_us_ > complete_time_us_ + stale_us_));
    const program_status::ProgramSource source = program_receiver_.source(bus_time_us_);
    found.set(Condition::program_unknown, source == program_status::ProgramSource::never_heard);
    found.set(Condition::program_silent, source == program_status::ProgramSource::silent);
    found.set(Condition::tool_unknown, has_begun_ && !tick_.is_tool_known());
    found.set(Condition::tool_change_due, tick_.is_change_due());
    found.set(Condition::override_foreign, is_override_foreign_);
    conditions_ = found;
}

bool CanController::take_frame(hal::CanFrame& frame) {
    return sync_.take_frame(frame) || sender_.take_frame(frame) || bus_.take_frame(frame) ||
           (way_ != nullptr && way_->take_frame(frame));
}

std::uint64_t CanController::next_event_us(std::uint64_t now_us) const {
    std::uint64_t next_us = now_us + std::min(settings_.feed_override.period_us, settings_.drives.sync_period_us);
    if (settings_.produces_sync && is_running_ && !stopped_) {
        next_us = std::min(next_us, sync_.next_us());
    }
    return std::max(next_us, now_us);
}

std::size_t CanController::filters(std::span<hal::CanFilter, filter_capacity> filters) const {
    std::size_t count = bus_.filters(filters.first<cia402::DriveBus::filter_capacity>());
    for (const std::uint32_t id :
         {settings_.program.id, program_status::speed_frame_id(settings_.program.id), tool_id(settings_, tools_),
          position_id(settings_, way_), way_id(way_), settings_.feed_override.id, own_heartbeat_id(settings_)}) {
        filters[count] = {id, hal::largest_standard_can_id};
        count += id != 0 ? 1U : 0U;
    }
    return count;
}

}  // namespace millforce::firmware
