// SPDX-License-Identifier: Apache-2.0
#include "bus/plant_on_can.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "files/input_error.hpp"

namespace millforce::sim {

namespace {
constexpr std::uint64_t longest_wait_us = 5'000;
}

PlantOnCan::PlantOnCan(const PlantOnCanSettings& settings, std::unique_ptr<host::CanPort> port)
    : settings_(settings),
      port_(std::move(port)),
      clock_(settings.time),
      machine_(settings.machine),
      cnc_(settings.cnc),
      heard_us_(port_->now_us()),
      plant_us_(now_us()),
      due_us_(plant_us_) {
    if (settings.tool != 0) {
        cnc_.set_tool(settings.tool, plant_us_);
    }
}

hal::FeedOverride PlantOnCan::step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    const std::uint64_t time_us = now_us();
    machine_.set(sample);
    cnc_.set(program, time_us);
    if (!settings_.computes_ahead) {
        answer_sync();
    }
    machine_.poll(time_us);
    cnc_.poll(time_us);
    send_all();
    await_sync();
    if (settings_.computes_ahead) {
        answer_sync();
        send_all();
    }
    const override_frame::ReceivedOverride got = cnc_.feed_override(due_us_);
    is_ready_ = is_ready_ || got.is_alive;
    return {got.ratio, got.hold, got.state, got.fault, 0};
}

void PlantOnCan::answer_sync() {
    if (!sync_is_pending_) {
        return;
    }
    const std::uint64_t time_us = now_us();
    sync_is_pending_ = false;
    longest_delay_us_ = std::max(longest_delay_us_, clock_.real_us(time_us > due_us_ ? time_us - due_us_ : 0));
    machine_.on_frame(sync_, time_us);
}

/// Until the next SYNC, or until the plant has to go on without one. `due_us_` is the time of it.
void PlantOnCan::await_sync() {
    for (;;) {
        const std::uint64_t port_us = port_->now_us();
        const std::uint64_t time_us = clock_.of_monotonic(port_us);
        port_->poll(port_us);
        if (receive_until_sync()) {
            return;
        }
        machine_.poll(time_us);
        cnc_.poll(time_us);
        send_all();
        if (settings_.time.in_lock_step) {
            check_patience(port_us);
        } else if (time_us >= plant_us_ + longest_wait_us) {
            due_us_ = time_us;
            check_patience(port_us);
            return;
        }
        const std::uint64_t end_us = plant_us_ + longest_wait_us;
        port_->wait(clock_.real_us(end_us > time_us ? end_us - time_us : longest_wait_us));
    }
}

bool PlantOnCan::receive_until_sync() {
    hal::CanFrame frame;
    std::uint64_t stamp_us = 0;
    while (port_->receive(frame, stamp_us)) {
        clock_.on_frame(frame);
        const std::uint64_t time_us = clock_.of_monotonic(stamp_us);
        if (frame.id == settings_.time.sync_id && !frame.extended && !frame.remote) {
            sync_ = frame;
            sync_is_pending_ = true;
            due_us_ = std::max(time_us, plant_us_);
            ++syncs_;
            const std::uint64_t heard_us = port_->now_us();
            check_patience(heard_us);
            heard_us_ = is_ready_ ? heard_us : heard_us_;
            return true;
        }
        machine_.on_frame(frame, time_us);
        cnc_.on_frame(frame, time_us);
    }
    return false;
}

/// Of a controller that is not there; in lock-step, of one that went away.
void PlantOnCan::check_patience(std::uint64_t port_us) const {
    const bool waits = !is_ready_ || settings_.time.in_lock_step;
    if (waits && port_us > heard_us_ + settings_.patience_us) {
        throw host::InputError(fmt::format("{}: no {} within {} s, expected 'millforce run' on the same interface",
                                           settings_.interface, is_ready_ ? "SYNC" : "feed override",
                                           settings_.patience_us / 1'000'000));
    }
}

void PlantOnCan::send_all() {
    for (const hal::CanFrame& frame : machine_.take_frames()) {
        port_->send(frame);
    }
    for (const hal::CanFrame& frame : cnc_.take_frames()) {
        port_->send(frame);
    }
}

OverrideSource::PlantSteps PlantOnCan::plant_steps(const PlantSteps& usual) {
    const double elapsed_s = 1e-6 * static_cast<double>(std::max<std::uint64_t>(due_us_ - plant_us_, 1));
    plant_us_ = due_us_;
    if (settings_.computes_ahead && syncs_ != stepped_syncs_) {
        stepped_syncs_ = syncs_;
        return usual;
    }
    const int count = std::max(1, static_cast<int>(std::lround(elapsed_s / usual.step_s)));
    return {count, elapsed_s / count};
}

}  // namespace millforce::sim
