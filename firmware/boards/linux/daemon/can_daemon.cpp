// SPDX-License-Identifier: Apache-2.0
#include "daemon/can_daemon.hpp"

#include <algorithm>
#include <array>

namespace millforce::host {

namespace {

using firmware::Condition;

constexpr std::uint64_t second_us = 1'000'000;
/// The override's sender finds out that ticks stay away (20 ms) and says so in its heartbeat.
constexpr std::uint64_t farewell_us = 40'000;
/// More than a bus of 1 Mbit/s carries in 10 ms: a computer that takes frames more slowly than they come goes on with
/// its loop.
constexpr int most_frames_per_turn = 256;

firmware::CanControllerSettings controller_settings(const MachineBus& bus) {
    firmware::CanControllerSettings settings;
    settings.drives = bus.drives;
    settings.produces_sync = bus.produces_sync;
    settings.feed_override = bus.feed_override;
    settings.program = bus.program;
    return settings;
}

/// In lock-step the loop waits as long as it takes.
std::uint64_t longest_turn_us(const ToolSet& tools, const BusTime& time) {
    const float stale_us = tools.parameters().machine.cnc.stale_s * 1e6F;
    return time.in_lock_step ? UINT64_MAX : time.slowness * static_cast<std::uint64_t>(stale_us);
}

}  // namespace

CanDaemon::CanDaemon(const socketcan::CanSocketSettings& interface, const MachineBus& bus, const ToolSet& tools,
                     Journal& journal, const CanDaemonSettings& settings, firmware::TickListener* watcher)
    : journal_(journal),
      watcher_(watcher),
      telemetry_(settings.telemetry),
      way_(settings.way),
      override_id_(bus.feed_override.id),
      entries_(run_log_interval_us),
      controller_(controller_settings(bus), tools.parameters(), this, tools.source(), settings.way),
      socket_(socket_settings(interface, controller_, settings.records)),
      clock_(settings.time, socket_.unix_offset_us()),
      sync_id_(bus.drives.sync_id),
      node_id_(bus.feed_override.node_id),
      local_drives_(bus),
      local_outputs_(bus.local),
      pause_watch_(longest_turn_us(tools, settings.time)) {}

socketcan::CanSocketSettings CanDaemon::socket_settings(socketcan::CanSocketSettings settings,
                                                        const firmware::CanController& controller, bool records) {
    settings.receive_own = true;
    if (!records) {
        std::array<hal::CanFilter, firmware::CanController::filter_capacity> filters{};
        settings.filter_count = controller.filters(filters);
        std::copy_n(filters.begin(), settings.filter_count, settings.filters.begin());
    }
    return settings;
}

void CanDaemon::run(const std::atomic<bool>& stop) {
    try {
        while (!stop.load(std::memory_order_relaxed)) {
            step();
        }
    } catch (...) {
        end(farewell_us);  // whatever happened, the last override says hold
        throw;
    }
    end(farewell_us);
}

std::uint64_t CanDaemon::now_us() const {
    return bus_time_us(socketcan::monotonic_us());
}

/// In lock-step the next SYNC is due when all drives have answered this one, or do not.
std::uint64_t CanDaemon::bus_time_us(std::uint64_t monotonic_us) const {
    const BusTime& time = clock_.time();
    const std::uint64_t passed_us = time.in_lock_step && has_cycle_ended(monotonic_us) ? time.sync_period_us : 0;
    return clock_.of_monotonic(monotonic_us) + passed_us;
}

bool CanDaemon::has_cycle_ended(std::uint64_t monotonic_us) const {
    constexpr std::uint64_t start_patience_us = 5'000;
    constexpr std::uint64_t patience_us = 1'000'000;
    const std::uint64_t elapsed_us = monotonic_us - sync_heard_us_;
    return elapsed_us > (controller_.ticks() == 0 ? start_patience_us : patience_us) ||
           (controller_.ticks() > 0 && !controller_.drives().is_collecting());
}

void CanDaemon::step() {
    const std::uint64_t before_us = now_us();
    socket_.wait(clock_.real_us(controller_.next_event_us(before_us) - before_us));
    const std::uint64_t turn_us = socketcan::monotonic_us();
    const std::uint64_t time_us = bus_time_us(turn_us);
    look_for_pause(turn_us, time_us);
    socket_.poll(turn_us);
    receive_frames();
    controller_.poll(time_us);
    send_all();
    local_outputs_.poll(socketcan::monotonic_us());
    record_ticks();
    hold_where_needed();
    firmware::finish_work(controller_);
    report(time_us);
    watchdog_.poll(turn_us);
}

/// After a pause the socket holds the frames of a cut that went on without an override.
void CanDaemon::look_for_pause(std::uint64_t turn_us, std::uint64_t time_us) {
    if (pause_watch_.look(turn_us)) {
        resumed_us_ = time_us;
        is_paused_ = true;
        hold_where_needed();
    }
}

void CanDaemon::hold_where_needed() {
    const std::uint32_t sample_after_us = controller_.sample().time_us - static_cast<std::uint32_t>(resumed_us_);
    const bool is_complete = !controller_.conditions().has(Condition::input_incomplete);
    is_paused_ = is_paused_ && !(is_complete && static_cast<std::int32_t>(sample_after_us) > 0);
    controller_.hold_from_outside(local_outputs_.health().is_failed || is_paused_);
}

void CanDaemon::end(std::uint64_t duration_us) {
    const std::uint64_t start_us = socketcan::monotonic_us();
    controller_.stop(now_us());
    while (socketcan::monotonic_us() < start_us + clock_.real_us(duration_us)) {
        step();
    }
}

void CanDaemon::receive_frames() {
    socketcan::ReceivedFrame received;
    for (int k = 0; k < most_frames_per_turn && socket_.receive(received); ++k) {
        const std::uint64_t unix_us = clock_.unix_us(received.time_us);
        journal_.record(received.frame, unix_us);
        clock_.on_frame(received.frame);
        if (received.is_own && override_frame::is_boot_up(received.frame, node_id_)) {
            clock_.begin();
        }
        controller_.on_frame(received.frame, clock_.of_monotonic(received.time_us), received.is_own);
        if (received.frame.id == sync_id_ && !received.frame.extended && !received.frame.remote) {
            sync_heard_us_ = socketcan::monotonic_us();
            read_beside_bus(unix_us);
        }
    }
}

void CanDaemon::read_beside_bus(std::uint64_t unix_us) {
    hal::DriveSource& source = local_drives_;
    source.poll(socketcan::monotonic_us());
    if (hal::DriveSample sample; source.take_sample(sample)) {
        journal_.record(sample, unix_us);
        controller_.add(sample);
    }
}

void CanDaemon::send_all() {
    hal::CanFrame frame;
    while (controller_.take_frame(frame)) {
        const bool is_new = frame.id == override_id_ && controller_.tick_time_us() != measured_tick_us_;
        if (socket_.send(frame) && is_new) {
            measured_tick_us_ = controller_.tick_time_us();
            const std::uint64_t sent_us = now_us();
            latency_.add(clock_.real_us(sent_us > measured_tick_us_ ? sent_us - measured_tick_us_ : 0));
        }
    }
}

void CanDaemon::on_tick(const firmware::CanController& controller) {
    if (watcher_ != nullptr) {
        watcher_->on_tick(controller);
    }
    local_outputs_.update(controller.sent_override(), socketcan::monotonic_us());
    if (unrecorded_count_ == unrecorded_.size()) {
        record_ticks();  // so many at once are a backlog: all but the last are too late for the CNC
    }
    TelemetrySample& sample = unrecorded_[unrecorded_count_++];
    sample.tick = controller.record();
    sample.tool = controller.tool();
    if (telemetry_ != nullptr) {
        add_for_watchers(controller, sample);
    }
}

void CanDaemon::add_for_watchers(const firmware::CanController& controller, TelemetrySample& sample) const {
    sample.monotonic_us = socketcan::monotonic_us();
    sample.is_held = controller.sent_override().hold;
    sample.drives = controller.sample();
    sample.program = controller.program();
    sample.conditions = reported_;
}

void CanDaemon::record_ticks() {
    for (std::size_t k = 0; k < unrecorded_count_; ++k) {
        const TelemetrySample& sample = unrecorded_[k];
        if (entries_.add(sample.tick, sample.tool, newest_)) {
            journal_.estimate(newest_);
        }
        if (telemetry_ != nullptr) {
            telemetry_->put(sample);
        }
    }
    unrecorded_count_ = 0;
}

firmware::Conditions CanDaemon::conditions(std::uint64_t now_us) {
    using socketcan::LinkState;
    const socketcan::LinkHealth& link = socket_.health();
    firmware::Conditions found = controller_.conditions();
    found.set(Condition::interface_absent, link.state == LinkState::absent);
    found.set(Condition::interface_down, link.state == LinkState::down);
    found.set(Condition::error_warning, link.state == LinkState::error_warning);
    found.set(Condition::error_passive, link.state == LinkState::error_passive);
    found.set(Condition::bus_off, link.state == LinkState::bus_off);
    found.set(Condition::send_queue_full, link.send_queue_full);
    found.set(Condition::local_input_failed, local_drives_.health().is_failed);
    found.set(Condition::local_output_failed, local_outputs_.health().is_failed);
    found.set(Condition::process_paused, is_paused_);
    found.set(Condition::map_refuted, way_ != nullptr && way_->is_refuted());
    if (const std::uint32_t lost = link.overruns + link.controller_overflows; lost != frames_lost_) {
        frames_lost_ = lost;
        frames_lost_us_ = now_us;
    }
    found.set(Condition::frames_lost, frames_lost_ > 0 && now_us < frames_lost_us_ + second_us);
    return found;
}

/// Includes the conditions of the last second: one that comes and goes quickly is reported once.
firmware::Conditions CanDaemon::recent(const firmware::Conditions& now, std::uint64_t now_us) {
    firmware::Conditions found;
    for (std::size_t k = 0; k < firmware::condition_count; ++k) {
        const auto condition = static_cast<Condition>(k);
        seen_us_[k] = now.has(condition) ? now_us : seen_us_[k];
        found.set(condition, seen_us_[k] != 0 && now_us < seen_us_[k] + second_us);
    }
    return found;
}

void CanDaemon::report(std::uint64_t now_us) {
    const firmware::Conditions now = recent(conditions(now_us), now_us);
    const bool is_periodic = now_us >= next_status_us_;
    const bool is_news = !has_reported_ || !(now == reported_);
    if (!is_periodic && !is_news) {
        return;
    }
    has_reported_ = true;
    reported_ = now;
    StatusEntry entry;
    entry.unix_us = now_us;
    entry.conditions = now;
    entry.link = socket_.health();
    entry.bus = controller_.drives().health();
    entry.rejects = controller_.drives().rejects();
    for (std::size_t role = 0; role < entry.drives.size(); ++role) {
        const auto drive = static_cast<cia402::DriveRole>(role);
        entry.drives[role] = controller_.drives().health(drive);
        entry.is_used[role] = controller_.drives().node(drive).node_id() != 0;
    }
    entry.ticks = controller_.ticks();
    entry.syncs_skipped = controller_.syncs_skipped();
    entry.newest = newest_;
    entry.input = local_drives_.health();
    entry.output = local_outputs_.health();
    entry.pause_us = pause_watch_.pause_us();
    if (is_news) {
        journal_.status(entry);
    }
    if (is_periodic) {
        next_status_us_ = now_us + second_us;
        entry.is_periodic = true;
        journal_.status(entry);
    }
}

}  // namespace millforce::host
