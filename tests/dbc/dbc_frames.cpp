// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "bus/machine_on_bus.hpp"
#include "bus_settings.hpp"
#include "cia402/drive_bus.hpp"
#include "cia402/sync_producer.hpp"
#include "emergency/emergencies.hpp"
#include "override_frame/override_sender.hpp"
#include "override_sender_settings.hpp"
#include "program_status/position_frame.hpp"
#include "program_status/program_status_frame.hpp"
#include "program_status/speed_frame.hpp"
#include "program_status/tool_frame.hpp"
#include "way_window/way_frames.hpp"

/// Frames of every kind that millforce.dbc names, by the code that sends them, each with the values that went in:
/// `id data name=value...`. check_dbc decodes them by the DBC and compares.

namespace {

using namespace millforce;
using Values = std::vector<std::pair<std::string, double>>;

void print(const hal::CanFrame& frame, const Values& values) {
    std::printf("%u ", frame.id);
    for (std::size_t k = 0; k < frame.length; ++k) {
        std::printf("%02X", frame.data[k]);
    }
    std::printf("%s", frame.length == 0 ? "-" : "");
    for (const auto& [name, value] : values) {
        std::printf(" %s=%.12g", name.c_str(), value);
    }
    std::printf("\n");
}

void print_override(const hal::FeedOverride& feed_override, double ratio, bool hold) {
    const hal::CanFrame frame = override_frame::encode(feed_override, override_frame::default_id);
    print(frame, {{"Ratio", ratio},
                  {"Hold", hold ? 1.0 : 0.0},
                  {"Reserved", 0.0},
                  {"State", feed_override.state},
                  {"Fault", feed_override.fault},
                  {"Counter", feed_override.heartbeat & 0xFFFFU},
                  {"Checksum", frame.data[7]}});
}

void print_overrides() {
    for (std::uint32_t k = 0; k <= 65'535; k += 97) {
        const float ratio = static_cast<float>(k) * override_frame::ratio_per_bit;
        print_override({ratio, k % 2 == 1, static_cast<std::uint8_t>(k % 7), static_cast<std::uint8_t>(k % 256), 3 * k},
                       k * 0.0001, k % 2 == 1);
    }
    print_override({1e9F, false, 255, 255, 0xFFFFFFFFU}, 6.5535, false);
}

void print_own_emergencies() {
    emergency::Emergencies emergencies(override_frame::default_node_id);
    for (std::uint32_t k = 0; k < emergency::reason_count; ++k) {
        const auto reason = static_cast<emergency::Reason>(k);
        const std::uint32_t detail = 0xFEDC'BA98U - k;
        print(emergencies.frame_of(reason, 0x6010, detail), {{"MillforceErrorCode", 0x6010},
                                                             {"MillforceErrorRegister", 1.0},
                                                             {"MillforceReason", k},
                                                             {"MillforceDetail", detail}});
    }
}

/// Boot-up, pre-operational, operational, stopped.
void print_heartbeats() {
    override_frame::OverrideSender sender{test::an_override_sender()};
    hal::CanFrame frame;
    std::array<double, 4> states{0, 127, 5, 4};
    std::size_t place = 0;
    for (const std::uint64_t now_us : {0U, 200'000U, 400'000U}) {
        if (now_us == 200'000) {
            sender.update({}, now_us);
        }
        sender.poll(now_us);
        while (sender.take_frame(frame)) {
            if (frame.id != override_frame::default_id && place < states.size()) {
                print(frame, {{"MillforceNmtState", states[place++]}});
            }
        }
    }
}

void print_program_status(const program_status::ProgramStatusFrame& status, double feed_mm_min, double percent) {
    const hal::CanFrame frame = program_status::encode(status, program_status::default_id);
    print(frame, {{"ProgrammedFeed", feed_mm_min},
                  {"OperatorOverride", percent},
                  {"Rapid", status.program.rapid ? 1.0 : 0.0},
                  {"FeedHold", status.program.feed_hold ? 1.0 : 0.0},
                  {"ResetFault", status.reset_fault ? 1.0 : 0.0},
                  {"StatusReserved", 0.0},
                  {"StatusCounter", status.counter},
                  {"StatusChecksum", frame.data[7]}});
}

void print_program_statuses() {
    program_status::ProgramStatusFrame status;
    for (unsigned k = 0; k < 256; k += 5) {
        const double feed_mm_min = 123.45 * k;
        status.program.programmed_feed_mm_s = static_cast<float>(feed_mm_min / 60.0);
        status.program.operator_override = static_cast<float>(k) * 0.01F;
        status.program.rapid = k % 2 == 1;
        status.program.feed_hold = k % 3 == 1;
        status.reset_fault = k % 7 == 1;
        status.counter = static_cast<std::uint16_t>(257 * k);
        print_program_status(status, feed_mm_min, k);
    }
    status.program.programmed_feed_mm_s = status.program.operator_override = 1e9F;
    print_program_status(status, 167772.15, 255.0);
}

void print_tools() {
    const std::uint32_t id = program_status::tool_frame_id(program_status::default_id);
    for (const std::uint32_t number : {0U, 1U, 258U, 70'007U, UINT32_MAX}) {
        const hal::CanFrame frame = program_status::encode_tool(number, id);
        print(frame, {{"ToolNumber", number}, {"ToolReserved", 0.0}, {"ToolChecksum", frame.data[7]}});
    }
}

void print_speeds() {
    const std::uint32_t id = program_status::speed_frame_id(program_status::default_id);
    for (const double rpm : {0.0, 0.5, 955.0, 24'000.0}) {
        const hal::CanFrame frame =
            program_status::encode_speed(static_cast<float>(1000.0 * rpm) * program_status::speed_rad_s_per_bit, id);
        print(frame, {{"CommandedSpeed", rpm}, {"SpeedReserved", 0.0}, {"SpeedChecksum", frame.data[7]}});
    }
}

void print_positions() {
    const std::uint32_t id = program_status::position_frame_id(program_status::default_id);
    for (std::uint32_t k = 0; k < 10; ++k) {
        const program_status::ProgramPosition position{70'007 * k + 1, 16.25F * static_cast<float>(k),
                                                       static_cast<std::uint8_t>(28 * k)};
        const hal::CanFrame frame = program_status::encode_position(position, id);
        print(frame, {{"ProgramLine", position.line},
                      {"DistanceToGo", 16.25 * k},
                      {"PositionCounter", position.counter},
                      {"PositionChecksum", frame.data[7]}});
    }
}

void print_way_window() {
    using namespace way_window;
    for (std::uint8_t k = 0; k < 8; ++k) {
        const auto session = static_cast<std::uint8_t>(k + 8);
        const hal::CanFrame frame = encode(WayFrame{static_cast<std::uint8_t>(31 * k), k, session, {1, 2, 3, 4, k}},
                                           way_frame_id(override_frame::default_node_id));
        print(frame, {{"WindowNumber", 31 * k},
                      {"WindowKind", k},
                      {"WindowSession", session},
                      {"WindowPayload", 0x0403'0201 + 4294967296.0 * k},
                      {"WindowChecksum", frame.data[7]}});
    }
    for (std::uint8_t k = 0; k <= static_cast<std::uint8_t>(WayState::refuted); ++k) {
        const auto expected = static_cast<std::uint16_t>(12'345 * k);
        const hal::CanFrame frame =
            encode(WayAnswer{k, static_cast<WayState>(k), k, expected, static_cast<std::uint8_t>(64 - k), 0xABCD},
                   way_answer_id(override_frame::default_node_id));
        print(frame, {{"AnswerAsk", k},
                      {"AnswerState", k},
                      {"AnswerSession", k},
                      {"AnswerExpected", expected},
                      {"AnswerRoom", 64 - k},
                      {"AnswerDigest", 0xABCD},
                      {"AnswerChecksum", frame.data[7]}});
    }
}

/// SYNC and NMT start, by the master.
void print_master() {
    cia402::BusSettings settings = test::a_bus();
    settings.is_master = true;
    settings.drives[0].node_id = 1;
    settings.drives[0].rated_current_A = 12.0F;
    settings.drives[0].pdos[0].id = 0x181;
    settings.drives[0].pdos[0].object_count = 2;
    settings.drives[0].pdos[0].objects = {cia402::MappedObject{cia402::object::position_actual, 0, 32},
                                          cia402::MappedObject{cia402::object::current_actual, 0, 16}};
    cia402::DriveBus bus(settings);
    cia402::SyncProducer sync(settings.sync_id, settings.sync_period_us);
    hal::CanFrame frame;
    for (std::uint64_t now_us = 0; now_us < 3000; now_us += 1000) {
        bus.poll(now_us);
        if (sync.poll(now_us) && sync.take_frame(frame)) {
            bus.on_frame(frame, now_us);
            print(frame, {});
        }
        while (bus.take_frame(frame)) {
            print(frame, frame.id == 0 ? Values{{"NmtCommand", 1}, {"NmtNode", 1}} : Values{});
        }
    }
}

struct DriveNames {
    const char* prefix;
    const char* count;
};
constexpr std::array<DriveNames, 4> drive_names{
    {{"Spindle", "SpindleCount"}, {"X", "XPosition"}, {"Y", "YPosition"}, {"Z", "ZPosition"}}};

void print_of_drive(const hal::CanFrame& frame, const DriveNames& names, std::int32_t position, double per_mille) {
    const std::string prefix = names.prefix;
    switch (frame.id & 0x780U) {
        case 0x180:
            print(frame,
                  {{names.count, position}, {prefix + "Current", per_mille / 1000.0}, {prefix + "Statusword", 0x0237}});
            break;
        case 0x080:
            print(frame, {{prefix + "ErrorCode", 0x3210}, {prefix + "ErrorRegister", 0x05}});
            break;
        case 0x700:
            print(frame, {{prefix + "NmtState", frame.data[0]}});
            break;
        default:
            break;
    }
}

/// The drives' side, which shares no code with the drivers.
void print_drives() {
    for (std::size_t place = 0; place < drive_names.size(); ++place) {
        sim::CanopenDriveSettings settings;
        settings.node_id = static_cast<std::uint8_t>(place + 1);
        settings.heartbeat_ms = 10;
        sim::CanopenDrive drive(settings);
        hal::CanFrame start;
        start.length = 2;
        start.data[0] = 1;
        hal::CanFrame sync;
        sync.id = 0x080;
        drive.on_frame(start, 0);
        for (int k = -20; k <= 20; ++k) {
            const std::int32_t position = 98'765'432 / 20 * k;
            drive.set_position(position);
            drive.set_current_A(12.0 * k);
            drive.on_frame(sync, static_cast<std::uint64_t>(k + 21) * 1000);
            if (k == 0) {
                drive.raise_emergency(0x3210, 0x05);
            }
            drive.poll(static_cast<std::uint64_t>(k + 21) * 1000);
            for (const hal::CanFrame& frame : drive.take_frames()) {
                print_of_drive(frame, drive_names[place], position, 1000.0 * k);
            }
        }
    }
}

}  // namespace

int main() {
    print_overrides();
    print_heartbeats();
    print_own_emergencies();
    print_program_statuses();
    print_tools();
    print_speeds();
    print_positions();
    print_way_window();
    print_master();
    print_drives();
    return 0;
}
