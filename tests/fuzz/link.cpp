// SPDX-License-Identifier: Apache-2.0
// Messages of the local link, into the controller behind `millforce serve`. For each message a byte for its kind: bytes
// as they are, or a head that is right and a body of bytes. The first byte chooses the controller: one tool, or
// several.
#include <algorithm>
#include <array>

#include "firmware/ready_tools.hpp"
#include "firmware_link/link_controller.hpp"
#include "fuzz/hostile_bytes.hpp"
#include "hal/finite.hpp"
#include "local_link/messages.hpp"
#include "parameters/parameter_files.hpp"

using namespace millforce;
using local_link::MessageError;

namespace {

constexpr float largest_override = 1.2F;
constexpr std::size_t head_bytes = 8;

struct Controllers {
    firmware::Parameters<float> parameters =
        host::read_parameters(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml",
                              MILLFORCE_SOURCE_DIR "/sim/scenarios/tools/endmill_10mm.toml");
    std::array<firmware::ReadyTool, 2> memory{};
    firmware::ReadyTools tools{memory};
    firmware::LinkController with_one_tool{parameters, largest_override};
    firmware::LinkController with_tools{parameters, largest_override, nullptr, &tools};

    Controllers() {
        firmware::Parameters<float> capped = parameters;
        capped.machine = firmware::capped(parameters.machine, largest_override);
        tools.add(1, capped);
        capped.tool.tooth_force_limit_N *= 0.5F;
        tools.add(7, capped);
    }
};

template <typename Message>
void require_written_as_read(fuzz::Input bytes) {
    Message message;
    if (decode(bytes, message) == MessageError::none) {
        const auto written = encode(message);
        fuzz::require(std::equal(bytes.begin(), bytes.end(), written.begin(), written.end()),
                      "a message that is read is written as it was");
    }
}

void send(firmware::LinkController& controller, fuzz::Input bytes) {
    require_written_as_read<local_link::SampleMessage>(bytes);
    require_written_as_read<local_link::OverrideMessage>(bytes);
    local_link::SampleMessage sample;
    const MessageError error = decode(bytes, sample);
    local_link::OverrideBytes answer{};
    fuzz::require(controller.on_message(bytes, answer) == error, "both see the same error");
    firmware::finish_work(controller);
    if (error != MessageError::none) {
        fuzz::require(answer == local_link::OverrideBytes{}, "what is refused is not answered");
        return;
    }
    local_link::OverrideMessage message;
    fuzz::require(decode(answer, message) == MessageError::none, "the answer is sound");
    fuzz::require(message.sequence == sample.sequence, "the answer is to this sample");
    fuzz::require(message.ratio <= largest_override, "the override is at most what the CNC takes");
    fuzz::require(message.hold || !sample.feed_hold || message.ratio <= largest_override, "bounded in a feed hold");
}

/// The body behind the head of a sample, or an override; a float may be anything.
void send_with_head(firmware::LinkController& controller, fuzz::Bytes& bytes) {
    local_link::SampleBytes message = encode(local_link::SampleMessage{});
    const fuzz::Input body = bytes.take(message.size() - head_bytes);
    std::copy(body.begin(), body.end(), message.begin() + head_bytes);
    send(controller, message);
}

/// Samples of a machine in order: time and count go on, and the rest comes from the bytes.
void send_in_order(firmware::LinkController& controller, fuzz::Bytes& bytes, local_link::SampleMessage& sample) {
    ++sample.sequence;
    sample.time_us += 1000;
    sample.spindle_count += bytes.u8();
    sample.present = bytes.u8() & 0x1FU;
    const std::uint8_t flags = bytes.u8();
    sample.rapid = (flags & 1U) != 0;
    sample.feed_hold = (flags & 2U) != 0;
    sample.reset = (flags & 4U) != 0;
    sample.spindle_current_A = static_cast<float>(bytes.u8()) * 0.2F;
    sample.axis_current_A[0] = static_cast<float>(bytes.u8()) * 0.1F;
    sample.axis_velocity_mm_s[0] = static_cast<float>(bytes.u8());
    sample.programmed_feed_mm_s = sample.axis_velocity_mm_s[0];
    sample.tool = bytes.u8() % 8U;
    send(controller, encode(sample));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Controllers controllers;
    fuzz::Bytes bytes({data, size});
    firmware::LinkController controller = bytes.u8() % 2 == 0 ? controllers.with_one_tool : controllers.with_tools;
    local_link::SampleMessage sample;
    while (bytes.any_left()) {
        const std::uint8_t kind = bytes.u8();
        if (kind < 100) {
            send(controller, bytes.take(kind));
        } else if (kind < 180) {
            send_with_head(controller, bytes);
        } else {
            send_in_order(controller, bytes, sample);
        }
    }
    return 0;
}
