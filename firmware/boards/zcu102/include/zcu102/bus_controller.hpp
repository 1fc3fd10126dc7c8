#pragma once

#include <cstdint>
#include <initializer_list>

#include "firmware_can/bus_settings.hpp"
#include "firmware_can/can_controller.hpp"
#include "zynqmp/can_controller.hpp"

/// The controller of a Zynq UltraScale+ whose drives and CNC are on its CAN bus: firmware::CanController over the chip's
/// CAN controller.

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

/// What the PDOs of the drives carry, which a parameter block does not hold: that of
/// sim/scenarios/machines/vmc.toml. Another mapping is another value here.
inline constexpr firmware::BusObjects bus_objects = [] {
    using detail::pdo_with;
    firmware::DriveObjects spindle{.count = {0x6064, 0}, .index_count = {0x60BA, 0}, .index_number = {0x60D5, 0}};
    spindle.pdos[0] = pdo_with({{0x6064, 0, 32}, {0x6078, 0, 16}, {0x6041, 0, 16}});
    spindle.pdos[1] = pdo_with({{0x60BA, 0, 32}, {0x60D5, 0, 16}});
    firmware::DriveObjects axis{.count = {0x6064, 0}};
    axis.pdos[0] = pdo_with({{0x606C, 0, 32}, {0x6078, 0, 16}, {0x6041, 0, 16}});
    return firmware::BusObjects{spindle, axis, axis, axis};
}();

/// poll() as often as possible: a frame's time is that of the poll which fetched it. A frame that was sent counts as heard
/// then: this CAN controller does not hear its own. After bus-off the bus is joined again 100 ms later; meanwhile no
/// override goes out, and the CNC holds the feed by itself. No heap. One thread.
class BusController {
  public:
    BusController(zynqmp::CanRegisters& registers, const firmware::CanControllerSettings& settings,
                  const firmware::Parameters<float>& parameters)
        : can_(registers), controller_(settings, parameters) {}

    void start(const zynqmp::CanBitTiming& timing);
    void poll(std::uint64_t now_us);

    [[nodiscard]] const zynqmp::CanController& can() const { return can_; }
    [[nodiscard]] const firmware::CanController& controller() const { return controller_; }

  private:
    void rejoin_after_bus_off(std::uint64_t now_us);

    zynqmp::CanController can_;
    zynqmp::CanBitTiming timing_{};
    firmware::CanController controller_;
    std::uint64_t on_bus_us_ = 0;  ///< last time that the controller was not off the bus
};

}  // namespace millforce::zcu102
