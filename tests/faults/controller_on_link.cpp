// SPDX-License-Identifier: Apache-2.0
#include "faults/controller_on_link.hpp"

#include <iterator>
#include <memory>

#include "firmware_link/link_controller.hpp"
#include "sample_message.hpp"

namespace millforce::faults {

namespace {

constexpr std::uint32_t guard_timeout_us = 100'000;

}  // namespace

const char* name_of(LinkFault fault) {
    constexpr const char* names[] = {"none",
                                     "nothing present",
                                     "30 % of the samples dropped",
                                     "sample repeated",
                                     "1 % of the messages altered",
                                     "1 % of the messages cut",
                                     "controller hangs"};
    static_assert(std::size(names) == link_faults);
    return names[static_cast<std::size_t>(fault)];
}

hal::FeedOverride ControllerOnLink::step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    if (fault_ != LinkFault::samples_repeated) {
        message_ = test::message_of(sample, program);
    }
    message_.sequence = ++sequence_;
    message_.reset = resets_;
    if (fault_ == LinkFault::nothing_present) {
        message_.present = 0;
    }
    if (is_answered(message_)) {
        answered_us_ = sample.time_us;
    }
    is_guarded_ = is_guarded_ || sample.time_us - answered_us_ > guard_timeout_us;
    return {answer_.ratio, answer_.hold || is_guarded_, answer_.state, answer_.fault, answer_.heartbeat};
}

void ControllerOnLink::repair(Exchange exchange) {
    fault_ = LinkFault::none;
    if (is_guarded_) {
        exchange_ = std::move(exchange);
        is_guarded_ = false;
        answered_us_ = message_.time_us;
    }
}

bool ControllerOnLink::is_answered(const local_link::SampleMessage& message) {
    const bool is_dropped = fault_ == LinkFault::samples_dropped && is_by_chance(0.3);
    if (is_guarded_ || is_dropped || fault_ == LinkFault::controller_hangs) {
        return false;
    }
    local_link::SampleBytes bytes = local_link::encode(message);
    std::size_t length = bytes.size();
    if (fault_ == LinkFault::message_altered && is_by_chance(0.01)) {
        const auto place = std::uniform_int_distribution<std::size_t>(0, length - 1)(random_);
        bytes[place] = static_cast<std::uint8_t>(std::uniform_int_distribution(0, 255)(random_));
    }
    if (fault_ == LinkFault::message_cut && is_by_chance(0.01)) {
        length = std::uniform_int_distribution<std::size_t>(0, length - 1)(random_);
    }
    local_link::OverrideBytes answer;
    const bool goes_on = exchange_(std::span(bytes).first(length), answer);
    is_guarded_ = !goes_on || decode(answer, answer_) != local_link::MessageError::none;
    return !is_guarded_;
}

ControllerOnLink::Exchange link_controller(const firmware::Parameters<float>& parameters) {
    auto controller = std::make_shared<firmware::LinkController>(parameters, parameters.machine.cnc.override_max);
    return [controller](std::span<const std::uint8_t> message, local_link::OverrideBytes& answer) {
        return controller->on_message(message, answer) == local_link::MessageError::none;
    };
}

}  // namespace millforce::faults
