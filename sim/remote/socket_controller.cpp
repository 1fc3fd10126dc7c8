// SPDX-License-Identifier: Apache-2.0
#include "remote/socket_controller.hpp"

#include <fmt/format.h>

#include "files/input_error.hpp"
#include "remote/controller_messages.hpp"

namespace millforce::sim {

namespace {

/// Nobody at the simulated machine holds the feed but the controller: a part on which it never comes back would not
/// end.
constexpr double longest_standstill_s = 10.0;

}  // namespace

SocketController::SocketController(const Scenario& scenario, const std::string& path, LineSocket::Patience patience)
    : path_(path),
      cnc_(scenario.parameters.machine.cnc),
      socket_(path, patience),
      name_(greet(scenario)),
      monitor_(monitoring(scenario.parameters)),
      counts_(scenario.parameters.machine.encoder_counts_per_rev) {}

std::string SocketController::greet(const Scenario& scenario) {
    try {
        socket_.send(hello_message(scenario));
        return read_ready(socket_.receive("the answer to hello"));
    } catch (const host::InputError& error) {
        give_up(error.what());
    }
}

hal::FeedOverride SocketController::step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    monitor_.step(sample, program);
    counts_.follow(sample);
    ++samples_;
    try {
        const hal::FeedOverride output = ask(sample, program);
        refuse_standstill(output);
        return output;
    } catch (const host::InputError& error) {
        give_up(error.what());
    }
}

hal::FeedOverride SocketController::ask(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    if (socket_.has_more()) {
        throw host::InputError(fmt::format("the controller sent more than one line before sample {}", samples_));
    }
    TracePoint estimate;
    monitor_.describe(estimate);
    socket_.send(sample_message({samples_, sample, program, counts_, estimate}));
    const std::string_view line = socket_.receive(fmt::format("the answer to sample {}", samples_));
    const ControllerAnswer answer = read_answer(line, samples_, cnc_);
    own_estimate_ = answer.estimate;
    hal::FeedOverride output;
    output.ratio = answer.override_ratio;
    output.hold = answer.hold;
    output.heartbeat = static_cast<std::uint32_t>(samples_);
    return output;
}

void SocketController::refuse_standstill(const hal::FeedOverride& output) {
    const bool stands = counts_.time_s() > 0.0 && (output.hold || !(output.ratio > 0.0F));
    stands_since_s_ = stands ? stands_since_s_ : counts_.time_s();
    if (stands && counts_.time_s() - stands_since_s_ > longest_standstill_s) {
        throw host::InputError(fmt::format("sample {}: the feed has been held for {:g} s, the program would not end",
                                           samples_, longest_standstill_s));
    }
}

void SocketController::describe(TracePoint& point) const {
    monitor_.describe(point);
    point.limit = 0;
    point.fault = 0;
    if (own_estimate_) {
        copy_estimate(*own_estimate_, point);
    }
}

void SocketController::end(const RunFigures& figures) {
    say_last(end_message(figures));
}

/// The run does not depend on whether the controller is still there to hear it.
void SocketController::say_last(const std::string& message) {
    try {
        socket_.send(message);
    } catch (const host::InputError&) {
        return;
    }
}

void SocketController::give_up(const std::string& why) {
    say_last(error_message(why));
    throw host::InputError(fmt::format("socket:{}: {}", path_, why));
}

}  // namespace millforce::sim
