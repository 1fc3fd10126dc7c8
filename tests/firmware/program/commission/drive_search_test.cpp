// SPDX-License-Identifier: Apache-2.0
#include "commission/drive_search.hpp"
#include "bus/canopen_drive.hpp"
#include "commission/drive_answers.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <deque>
#include <vector>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

/// Simulated drives on a bus in memory. Time passes where nothing comes.
class DrivesInMemory {
  public:
    void add(const sim::CanopenDriveSettings& settings) {
        drives_.emplace_back(settings);
        (void)drives_.back().take_frames();  // its boot-up was before
    }
    SearchBus bus() {
        return {[this](const hal::CanFrame& frame) { deliver(frame); }, [this] { return next(); },
                [this] { return now_us_; }};
    }
    void disturb(const hal::CanFrame& frame) { waiting_.push_back(frame); }
    [[nodiscard]] const std::vector<sim::CanopenDrive>& drives() const { return drives_; }

  private:
    void deliver(const hal::CanFrame& frame) {
        for (sim::CanopenDrive& drive : drives_) {
            drive.on_frame(frame, now_us_);
            for (const hal::CanFrame& answer : drive.take_frames()) {
                waiting_.push_back(answer);
            }
        }
    }
    std::optional<hal::CanFrame> next() {
        if (waiting_.empty()) {
            now_us_ += 5'000;
            return std::nullopt;
        }
        const hal::CanFrame frame = waiting_.front();
        waiting_.pop_front();
        return frame;
    }

    std::vector<sim::CanopenDrive> drives_;
    std::deque<hal::CanFrame> waiting_;
    std::uint64_t now_us_ = 1'000'000;
};

sim::CanopenDriveSettings drive_at(std::uint8_t node) {
    sim::CanopenDriveSettings settings;
    settings.node_id = node;
    settings.rated_current_A = 3.5;
    settings.rated_torque_Nm = 2.0;
    return settings;
}

/// Of which nothing but its node is known.
FoundDrive bare_drive(std::uint8_t node) {
    FoundDrive drive;
    drive.node_id = node;
    drive.device_type = 0x00020192;
    return drive;
}

}  // namespace

TEST_GROUP(DriveSearch) {
    DrivesInMemory memory;
};

TEST(DriveSearch, finds_each_drive_with_its_ratings_and_changes_none) {
    memory.add(drive_at(5));
    memory.add(drive_at(127));
    const auto found = find_drives(memory.bus());
    UNSIGNED_LONGS_EQUAL(2, found.size());
    UNSIGNED_LONGS_EQUAL(5, found[0].node_id);
    UNSIGNED_LONGS_EQUAL(127, found[1].node_id);
    CHECK(found[0].is_cia402());
    UNSIGNED_LONGS_EQUAL(3500, found[0].rated_current_mA.value());
    UNSIGNED_LONGS_EQUAL(8192, found[0].encoder_counts.value());
    CHECK(found[0].has_index_latch);
    DOUBLES_EQUAL(0.001, found[0].velocity_mm_s(10.0).value(), 1e-12);
    for (const sim::CanopenDrive& drive : memory.drives()) {
        UNSIGNED_LONGS_EQUAL(127, drive.nmt_state());  // pre-operational, as before
    }
}

TEST(DriveSearch, an_empty_bus_is_an_answer_after_its_time_outs) {
    CHECK(find_drives(memory.bus()).empty());
    Answers answers("", {});
    CHECK(contains(message_of<InputError>([&] { answers_of_drives({}, {"x"}, answers); }), "no node answers"));
}

TEST(DriveSearch, reads_the_units_of_makers_in_metres_and_in_turns) {
    FoundDrive drive;
    const auto unit = [&](std::uint32_t value) {
        drive.velocity_unit = value;
        return drive.velocity_mm_s(5.0).value_or(-1.0);
    };
    DOUBLES_EQUAL(0.001, unit(0xFA010300), 1e-12);         // µm/s
    DOUBLES_EQUAL(5.0 / 60.0, unit(0x00B44700), 1e-12);    // 1/min: as Nanotec and Synapticon deliver
    DOUBLES_EQUAL(0.005 / 60.0, unit(0xFDB44700), 1e-12);  // 0.001 1/min
    DOUBLES_EQUAL(-1.0, unit(0x00410300), 0.0);            // degrees: not known
}

TEST(DriveSearch, what_the_drives_say_answers_the_questions_for_the_machine) {
    memory.add(drive_at(1));
    memory.add(drive_at(2));
    const auto found = find_drives(memory.bus());
    Answers answers("", {"x.travel_per_motor_turn_mm=10"});
    const std::string text = answers_of_drives(found, {"x"}, answers);
    for (const char* line : {"bus.spindle.node_id = 1\n", "bus.x.node_id = 2\n", "spindle.rated_torque_Nm = 2.0\n",
                             "spindle.encoder_counts_per_rev = 8192\n", "x.rated_current_A = 3.5\n",
                             "bus.x.velocity_mm_s_per_unit = 0.001\n"}) {
        CHECK_TEXT(contains(text, line), line);
    }
    Answers other("", {"bus.spindle.node_id=9"});
    CHECK(contains(message_of<InputError>([&] { answers_of_drives(found, {"x"}, other); }),
                   "bus.spindle.node_id = 9: no CiA 402 drive answers there"));
}

TEST(DriveSearch, of_a_drive_that_states_nothing_answers_its_node_alone) {
    Answers answers("", {});
    STRCMP_EQUAL("bus.spindle.node_id = 3\nbus.x.node_id = 4\n",
                 answers_of_drives({bare_drive(3), bare_drive(4)}, {"x"}, answers).c_str());
    STRCMP_EQUAL("node 3: CiA 402 drive", bare_drive(3).words().c_str());
    CHECK_FALSE(bare_drive(3).velocity_mm_s(5.0).has_value());
}

TEST(DriveSearch, gives_an_axis_its_torque_for_each_ampere_and_no_velocity_in_a_unit_that_it_does_not_know) {
    FoundDrive axis = bare_drive(4);
    axis.rated_current_mA = 4000;
    axis.velocity_unit = 0x00410300;  // degrees
    Answers answers("", {"x.travel_per_motor_turn_mm=5"});
    const std::string without_torque = answers_of_drives({bare_drive(3), axis}, {"x"}, answers);
    CHECK_TEXT(!contains(without_torque, "torque_constant"), without_torque.c_str());
    CHECK_TEXT(!contains(without_torque, "velocity_mm_s_per_unit"), without_torque.c_str());
    axis.rated_torque_mNm = 2000;
    CHECK(contains(answers_of_drives({bare_drive(3), axis}, {"x"}, answers), "x.torque_constant_Nm_per_A = 0.5\n"));
    STRCMP_EQUAL("node 4: CiA 402 drive, rated 4 A and 2 N·m", axis.words().c_str());
}

TEST(DriveSearch, a_node_that_is_no_drive_cannot_be_the_spindle_or_an_axis) {
    FoundDrive terminal;
    terminal.node_id = 9;
    terminal.device_type = 0x000F0191;
    STRCMP_EQUAL("node 9: device type 0x000F0191, no drive", terminal.words().c_str());
    Answers answers("", {"bus.x.node_id=9"});
    STRCMP_EQUAL("bus.x.node_id = 9: no CiA 402 drive answers there",
                 message_of<InputError>([&] {
                     answers_of_drives({bare_drive(3), terminal}, {"x"}, answers);
                 }).c_str());
}

TEST(DriveSearch, names_the_axis_for_which_no_node_is_left) {
    Answers answers("", {});
    STRCMP_EQUAL("bus.x.node_id: missing: only 1 of 2 nodes answer on this bus; expected the x drive powered",
                 message_of<InputError>([&] { answers_of_drives({bare_drive(3)}, {"x"}, answers); }).c_str());
}

TEST(DriveSearch, listens_past_frames_that_are_no_answers) {
    memory.add(drive_at(5));
    memory.disturb({.id = 0x585, .extended = true, .length = 8, .data = {0x43, 0x00, 0x10}});
    memory.disturb({.id = 0x585, .remote = true});
    memory.disturb({.id = 0x80, .length = 0});
    memory.disturb({.id = 0x700, .length = 1});
    const auto found = find_drives(memory.bus());
    UNSIGNED_LONGS_EQUAL(1, found.size());
    UNSIGNED_LONGS_EQUAL(5, found[0].node_id);
}
