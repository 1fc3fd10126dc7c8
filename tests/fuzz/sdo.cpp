// SPDX-License-Identifier: Apache-2.0
// Answers to SDO requests. For each answer: the time since the request, how it differs from a right one, and its bytes.
// They go to a client that asks on its own, and to a bus that reads its drives' settings before it takes their
// currents.
#include "drivers/cia402/bus_bench.hpp"
#include "fuzz/hostile_bytes.hpp"
#include "hal/finite.hpp"

using namespace millforce;
using namespace millforce::cia402;

namespace {

/// An answer to the request, of the drive with this id, that differs as the bytes say.
hal::CanFrame answer_to(const hal::CanFrame& request, fuzz::Bytes& bytes) {
    const std::uint8_t shape = bytes.u8();
    hal::CanFrame answer = request;
    answer.id = request.id - cob_id::sdo_request + cob_id::sdo_response;
    answer.data[0] = request.data[0] == 0x40 ? std::uint8_t{0x43} : std::uint8_t{0x60};
    for (std::size_t k = 4; k < 8; ++k) {
        answer.data[k] = bytes.u8();
    }
    if ((shape & 1U) != 0) {
        answer.data[0] = bytes.u8();
    }
    if ((shape & 2U) != 0) {
        answer.data[1 + bytes.u8() % 3U] = bytes.u8();
    }
    if ((shape & 4U) != 0) {
        answer.length = bytes.u8();
    }
    if ((shape & 8U) != 0) {
        answer.id ^= bytes.u8();
    }
    return answer;
}

void ask_alone(fuzz::Bytes bytes) {
    SdoClient client(5);
    RejectCounters rejects;
    SdoRequest request{0x6075, 0, static_cast<std::uint8_t>(bytes.u8() % 5U), 0x1234};
    std::uint64_t now_us = 0;
    int sent_frames = 0;
    client.ask(request, now_us);
    while (bytes.any_left()) {
        now_us += 1000U * bytes.u8();
        client.poll(now_us);
        hal::CanFrame sent;
        while (client.take_frame(sent)) {
            fuzz::require(++sent_frames <= 2 + SdoClient::repetitions, "a request, its repetitions and an abort");
            fuzz::require(sent.id == cob_id::sdo_request + 5U && sent.length == 8, "a request is an SDO frame");
        }
        hal::CanFrame asked = sent;
        asked.id = cob_id::sdo_request + 5U;
        const SdoState before = client.state();
        const hal::CanFrame answer = answer_to(asked, bytes);
        client.on_frame(answer, rejects);
        const bool is_new = before != SdoState::done && client.state() == SdoState::done;
        fuzz::require(!is_new || (answer.length == 8 && answer.data[1] == 0x75 && answer.data[2] == 0x60),
                      "only an answer to what was asked is taken");
        fuzz::require(before == SdoState::pending || client.state() == before, "an answer is taken once");
    }
}

void require_finite(const hal::DriveSample& sample) {
    fuzz::require(hal::is_finite(sample.spindle_current_A) && hal::is_finite(sample.axis_current_A[0]) &&
                      hal::is_finite(sample.axis_velocity_mm_s[0]),
                  "what the drives say is finite");
}

/// The drives of both nodes boot, answer, and send a PDO after each SYNC.
void prepare_drives(fuzz::Bytes bytes) {
    static const BusSettings settings = bench::two_drives();
    DriveBus bus(settings);
    bench::OwnSync sync(settings);
    std::uint64_t now_us = 0;
    bus.poll(now_us);
    bus.on_frame(frame_of(0x701, {0}), now_us);
    bus.on_frame(frame_of(0x702, {0}), now_us);
    while (bytes.any_left()) {
        now_us += 100U * bytes.u8();
        bus.poll(now_us);
        hal::CanFrame sent;
        if (sync.poll(bus, now_us, sent)) {
            bus.on_frame(frame_of(0x181, {1, 2, 3, 0, 5, 0, 0x27, 0}), now_us);
        }
        int count = 0;
        while (bus.take_frame(sent)) {
            fuzz::require(
                sent.length <= hal::largest_can_length && sent.id <= hal::largest_standard_can_id && ++count < 100,
                "what is sent are a few frames of a bus");
            if ((sent.id & 0x780U) == cob_id::sdo_request) {
                bus.on_frame(answer_to(sent, bytes), now_us);
            }
        }
        hal::DriveSample sample;
        while (bus.take_sample(sample)) {
            require_finite(sample);
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    ask_alone(fuzz::Bytes({data, size}));
    prepare_drives(fuzz::Bytes({data, size}));
    return 0;
}
