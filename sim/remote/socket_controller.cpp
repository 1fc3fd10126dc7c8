// SPDX-License-Identifier: Apache-2.0
#include "remote/socket_controller.hpp"

#include <fmt/format.h>

#include "files/input_error.hpp"
#include "remote/controller_messages.hpp"

namespace millforce::sim {

SocketController::SocketController(const Scenario& scenario, const std::string& path, LineSocket::Patience patience)
    : path_(path), socket_(path, patience), name_(greet(scenario)), controller_(scenario) {}

std::string SocketController::greet(const Scenario& scenario) {
    try {
        socket_.send(hello_message(scenario));
        return read_ready(socket_.receive("the answer to hello"));
    } catch (const host::InputError& error) {
        give_up(error.what());
    }
}

hal::FeedOverride SocketController::step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    try {
        return ask(sample, program);
    } catch (const host::InputError& error) {
        give_up(error.what());
    }
}

hal::FeedOverride SocketController::ask(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    const std::string question = controller_.ask(sample, program);
    const std::uint64_t number = controller_.sample_number();
    if (socket_.has_more()) {
        throw host::InputError(fmt::format("the controller sent more than one line before sample {}", number));
    }
    socket_.send(question);
    return controller_.take(socket_.receive(fmt::format("the answer to sample {}", number)));
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
