// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>

#include "emergency/emergencies.hpp"
#include "firmware_can/bus_settings.hpp"
#include "firmware_can/can_controller.hpp"
#include "firmware_can/way_of_tools.hpp"
#include "hal/reset_cause.hpp"
#include "zynqmp/can_controller.hpp"
#include "zynqmp/watchdog.hpp"

/// The controller of a Zynq UltraScale+ whose drives and CNC are on its CAN bus: firmware::CanController over the
/// chip's CAN controller.

namespace millforce::zcu102 {

namespace detail {
constexpr cia402::PdoMapping pdo_with(std::initializer_list<cia402::MappedObject> objects) {
    cia402::PdoMapping pdo;
    for (const cia402::MappedObject& object : objects) {
        pdo.objects[pdo.object_count++] = object;
    }
    return pdo;
}
}  // namespace detail

/// What the PDOs of the drives carry, which a parameter block does not hold: that of sim/scenarios/machines/vmc.toml.
/// For another mapping, change it here.
inline constexpr firmware::BusObjects bus_objects = [] {
    using detail::pdo_with;
    firmware::DriveObjects spindle{.count = {0x6064, 0}, .index_count = {0x60BA, 0}, .index_number = {0x60D5, 0}};
    spindle.pdos[0] = pdo_with({{0x6064, 0, 32}, {0x6078, 0, 16}, {0x6041, 0, 16}});
    spindle.pdos[1] = pdo_with({{0x60BA, 0, 32}, {0x60D5, 0, 16}});
    firmware::DriveObjects axis{.count = {0x6064, 0}};
    axis.pdos[0] = pdo_with({{0x606C, 0, 32}, {0x6078, 0, 16}, {0x6041, 0, 16}});
    return firmware::BusObjects{spindle, axis, axis, axis};
}();

struct Peripherals {
    zynqmp::CanRegisters& can;
    zynqmp::WatchdogRegisters& watchdog;
    zynqmp::ErrorRegisters& errors;
};

/// Not short, since the CNC stops the feed by itself after 20 ms of silence; longer than the longest work outside the
/// tick, the fit of a flute profile (estimation/depth_shape/flute_profile_fit.hpp).
inline constexpr std::uint32_t watchdog_us = 200'000;
inline constexpr std::uint32_t watchdog_clock_MHz = 100;

/// poll() as often as possible: it fetches one frame, whose time is that of the poll, so that a babbling node delays
/// nothing else. A frame that was sent counts as heard then: this CAN controller does not hear its own. After bus-off
/// the bus is joined again 100 ms later; meanwhile no override goes out, and the CNC holds the feed by itself. No heap.
/// One thread.
///
/// The first healthy tick starts the watchdog, and healthy ticks feed it: the heartbeat went on and the ratio is within
/// the limits. Frames drive the ticks. If none passes for 5 ms, not even one of this controller, no tick is due, and
/// polling feeds the watchdog: a reset would not bring the bus back. A ratio beyond the limits holds the feed until the
/// reset.
///
/// | what happens | on the bus, from emergency/emergencies.hpp |
/// |---|---|
/// | start | boot-up, EMCY with the reset's cause, 0x6010 after a watchdog |
/// | a sample lacks something, once the ticks have begun | EMCY 0x5000 |
/// | the CNC tells a tool that is not in the block, or none | the operator's override, EMCY 0xFF01 with the number |
/// | fault of the tick | the override frame's fault, EMCY 0xFF00 |
/// | bus-off | silence, EMCY 0x8140 when it is back |
/// | fault of the processor, a tick that hangs or answers nonsense | silence, reset, EMCY 0x6010 after it |
class BusController {
  public:
    /// With `tools`, which outlive this, the CNC tells which of them is in the spindle. A sender on the bus may hand
    /// over the part map of the tool in the spindle (way_over_bus.hpp).
    BusController(const Peripherals& peripherals, const firmware::CanControllerSettings& settings,
                  const firmware::Parameters<float>& parameters, const firmware::ReadyTools* tools = nullptr);

    void start(const zynqmp::CanBitTiming& timing, hal::ResetCause cause);
    void poll(std::uint64_t now_us);

    [[nodiscard]] const zynqmp::CanController& can() const { return can_; }
    [[nodiscard]] const firmware::CanController& controller() const { return controller_; }

  private:
    void rejoin_after_bus_off(std::uint64_t now_us);
    void exchange_frames(std::uint64_t now_us);
    void guard_ticks(std::uint64_t now_us);
    void feed_watchdog();
    void report_what_is_wrong();

    zynqmp::CanController can_;
    zynqmp::Watchdog watchdog_;
    emergency::Emergencies emergencies_;
    zynqmp::CanBitTiming timing_{};
    std::optional<firmware::WayOfTools> way_{};
    firmware::CanController controller_;
    float largest_ratio_;
    std::uint64_t on_bus_us_ = 0;  ///< last time that the controller was not off the bus
    std::uint64_t heard_us_ = 0;   ///< time of the newest frame, including those sent
    bool has_sent_ = false;        ///< the boot-up comes before any emergency
    std::uint32_t healthy_ticks_ = 0;
    std::uint32_t bus_offs_ = 0;
};

}  // namespace millforce::zcu102
