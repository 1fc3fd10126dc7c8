// SPDX-License-Identifier: Apache-2.0
#include "can_frames.hpp"
#include "cia402/drive_bus.hpp"
#include "parameters/machine_bus.hpp"
#include "parameters/parameter_files.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;

namespace {

/// The tables of drivers/can_machines/<name>.toml, by the reader of the program.
MachineBus tables_of(const char* name) {
    return read_machine_bus(MILLFORCE_SOURCE_DIR "/drivers/can_machines/" + std::string(name)).value();
}

/// What the drives of a machine answer to one SYNC after the other becomes samples.
class Listening {
  public:
    explicit Listening(const MachineBus& machine) : period_us_(machine.drives.sync_period_us), bus_(machine.drives) {
        CHECK_FALSE(machine.drives.is_master);
        CHECK_FALSE(machine.produces_sync);
        bus_.poll(now_us_);
        for (const std::uint32_t node : {1U, 2U, 3U}) {
            bus_.on_frame(frame_of(0x700 + node, {0x05}), now_us_);
        }
    }
    hal::DriveSample sample_of(const std::vector<hal::CanFrame>& answers) {
        hal::DriveSample sample;
        now_us_ += period_us_;
        bus_.on_frame(frame_of(0x80, {}), now_us_);
        for (const hal::CanFrame& frame : answers) {
            bus_.on_frame(frame, now_us_ + 300);
        }
        bus_.poll(now_us_ + period_us_ - 1);
        CHECK(bus_.take_sample(sample));
        hal::CanFrame sent;
        CHECK_FALSE(bus_.take_frame(sent));  // a listener sends nothing
        return sample;
    }

  private:
    std::uint64_t period_us_;
    std::uint64_t now_us_ = 1'000'000;
    cia402::DriveBus bus_;
};

}  // namespace

TEST_GROUP(CanMachines){};

TEST(CanMachines, of_akd_drives_give_amperes_by_per_mille_of_the_drive_s_rated_current_and_mm_s_by_0_001_rpm) {
    Listening bus(tables_of("akd.toml"));
    // 500 ‰ of 12 A; −250 ‰ of 6 A at 600 rpm of a 10 mm screw; standing still.
    const std::vector<hal::CanFrame> answers{frame_of(0x181, {0x00, 0x00, 0x10, 0x00, 0xF4, 0x01, 0x37, 0x02}),
                                             frame_of(0x182, {0xC0, 0x27, 0x09, 0x00, 0x06, 0xFF, 0x37, 0x02}),
                                             frame_of(0x183, {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x37, 0x02})};
    const hal::DriveSample sample = bus.sample_of(answers);
    UNSIGNED_LONGS_EQUAL(hal::mask(hal::Present::spindle_count) | hal::mask(hal::Present::spindle_current) |
                             hal::axis_mask(0) | hal::axis_mask(1),
                         sample.present);
    DOUBLES_EQUAL(6.0, sample.spindle_current_A, 1e-5);
    DOUBLES_EQUAL(-1.5, sample.axis_current_A[0], 1e-5);
    DOUBLES_EQUAL(100.0, sample.axis_velocity_mm_s[0], 1e-3);
    DOUBLES_EQUAL(0.0, sample.axis_velocity_mm_s[1], 0.0);
}

TEST(CanMachines, of_akd_drives_compare_velocity_and_position) {
    const MachineBus machine = tables_of("akd.toml");
    const cia402::DriveSettings& x = machine.drives.drives[1];
    DOUBLES_EQUAL(10.0 / 60.0 * 0.001, static_cast<double>(x.velocity_mm_s_per_unit), 1e-10);
    DOUBLES_EQUAL(10.0 / 1048576.0, static_cast<double>(x.position_mm_per_unit), 1e-11);
    UNSIGNED_LONGS_EQUAL(5, x.pdos[1].transmission_type);
}

TEST(CanMachines, of_nanotec_drives_give_mm_s_by_the_steps_of_the_position) {
    Listening bus(tables_of("nanotec.toml"));
    // From 0 to 400 units of 0.1 µm in 4 ms: 10 mm/s. 200 ‰ of 1.65 A.
    const std::vector<hal::CanFrame> first{frame_of(0x182, {0x00, 0x00, 0x00, 0x00, 0xC8, 0x00, 0x37, 0x02}),
                                           frame_of(0x183, {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x37, 0x02})};
    const std::vector<hal::CanFrame> second{frame_of(0x182, {0x90, 0x01, 0x00, 0x00, 0xC8, 0x00, 0x37, 0x02}),
                                            frame_of(0x183, {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x37, 0x02})};
    (void)bus.sample_of(first);
    const hal::DriveSample sample = bus.sample_of(second);
    DOUBLES_EQUAL(0.33, sample.axis_current_A[0], 1e-6);
    DOUBLES_EQUAL(10.0, sample.axis_velocity_mm_s[0], 1e-3);
}

TEST(CanMachines, of_an_ax2000_take_the_count_from_the_bus_and_leave_the_current_to_a_converter) {
    const MachineBus machine = tables_of("ax2000.toml");
    CHECK_FALSE(machine.drives.drives[0].gives_current);
    CHECK(machine.drives.drives[0].gives_motion);
    Listening bus(machine);
    const hal::DriveSample sample = bus.sample_of({frame_of(0x181, {0x78, 0x56, 0x34, 0x12, 0x37, 0x02})});
    UNSIGNED_LONGS_EQUAL(0x12345678, sample.spindle_count);
    CHECK((sample.present & hal::mask(hal::Present::spindle_current)) == 0);
}
