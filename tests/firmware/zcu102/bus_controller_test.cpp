#include "drivers/zynqmp/fake_can.hpp"
#include "zcu102/bus_controller.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;

namespace {

/// A bus whose drives are asked for nothing: this controller makes the SYNC alone.
firmware::Parameters<float> with_a_bus() {
    firmware::Parameters<float> parameters;
    auto& bus = parameters.machine.bus;
    bus.produces_sync = 1.0F;
    parameters.machine.spindle_rated_current_A = 10.0F;
    parameters.machine.axis_rated_current_A = {5.0F, 5.0F, 5.0F};
    for (std::size_t k = 0; k < bus.drives.size(); ++k) {
        bus.drives[k].node_id = static_cast<float>(k + 1);
        bus.drives[k].velocity_mm_s_per_unit = 0.001F;
        bus.drives[k].tpdo_every[1] = 4.0F;
    }
    return parameters;
}

}  // namespace

TEST_GROUP(Zcu102Bus) {
    FakeZynqCan chip;
    firmware::Parameters<float> parameters = with_a_bus();
    firmware::CanControllerSettings settings =
        firmware::can_controller_settings(parameters.machine, zcu102::bus_objects);
    zcu102::BusController controller{chip.registers, settings, parameters};

    /// Frames with this id that leave until then.
    int frames_until(std::uint64_t& now_us, std::uint64_t end_us, std::uint32_t id) {
        int frames = 0;
        for (; now_us < end_us; now_us += 50) {
            chip.registers.transmit.identifier = 0;
            controller.poll(now_us);
            chip.react();
            frames += chip.registers.transmit.identifier == id << 21U ? 1 : 0;
        }
        return frames;
    }
};

TEST(Zcu102Bus, the_usual_mapping_and_the_table_s_numbers_make_settings_that_pass) {
    CHECK_TRUE(cia402::SettingsError::none == cia402::check(settings.drives));
    UNSIGNED_LONGS_EQUAL(0x181, settings.drives.drives[0].pdos[0].id);
    UNSIGNED_LONGS_EQUAL(0x281, settings.drives.drives[0].pdos[1].id);
    UNSIGNED_LONGS_EQUAL(0x184, settings.drives.drives[3].pdos[0].id);
    UNSIGNED_LONGS_EQUAL(1000, settings.drives.sync_period_us);
}

TEST(Zcu102Bus, a_SYNC_leaves_each_millisecond_and_counts_as_heard) {
    std::uint64_t now_us = 0;
    controller.start(zynqmp::kbit_1000);
    chip.react();
    const int syncs = frames_until(now_us, 100'000, 0x080);
    CHECK_COMPARE(syncs, >=, 95);
    CHECK_COMPARE(syncs, <=, 101);
    CHECK_FALSE(controller.controller().drives().health().sync_lost);
    CHECK_COMPARE(controller.controller().drives().health().syncs, >=, 95);
}

TEST(Zcu102Bus, after_bus_off_it_is_silent_for_a_tenth_of_a_second_and_joins_again) {
    std::uint64_t now_us = 0;
    controller.start(zynqmp::kbit_1000);
    chip.react();
    frames_until(now_us, 10'000, 0x080);
    chip.registers.isr = 1U << 9U;
    LONGS_EQUAL(0, frames_until(now_us, 105'000, 0x080));
    CHECK_TRUE(zynqmp::CanState::bus_off == controller.can().state());
    const int syncs = frames_until(now_us, 200'000, 0x080);
    CHECK_COMPARE(syncs, >=, 80);
    UNSIGNED_LONGS_EQUAL(1, controller.can().health().bus_offs);
}
