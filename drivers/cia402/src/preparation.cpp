// SPDX-License-Identifier: Apache-2.0
#include "preparation.hpp"

#include "cia402/objects.hpp"

namespace millforce::cia402 {

namespace {

constexpr std::uint32_t pdo_switched_off = 0x8000'0000U;

/// Writing a mapping takes its objects, and these around them.
constexpr std::uint8_t steps_around_objects = 5;

SdoRequest mapping_step(const PdoMapping& pdo, std::uint16_t number, std::uint8_t step) {
    const auto communication = static_cast<std::uint16_t>(object::tpdo_communication + number);
    const auto mapping = static_cast<std::uint16_t>(object::tpdo_mapping + number);
    const auto objects = static_cast<std::uint8_t>(pdo.mapped().size());
    if (step == 0) {
        return {communication, 1, 4, pdo.id | pdo_switched_off};
    }
    if (step == 1) {
        return {mapping, 0, 1, 0};
    }
    if (step < 2 + objects) {
        const MappedObject& object = pdo.objects[step - 2U];
        return {mapping, static_cast<std::uint8_t>(step - 1U), 4,
                (std::uint32_t{object.index} << 16U) | (std::uint32_t{object.subindex} << 8U) | object.bits};
    }
    switch (step - objects) {
        case 2:
            return {mapping, 0, 1, objects};
        case 3:
            return {communication, 2, 1, pdo.transmission_type};
        default:
            return {communication, 1, 4, pdo.id};
    }
}

}  // namespace

bool preparation_step(const DriveSettings& settings, std::uint8_t step, SdoRequest& request) {
    const bool by_torque = settings.current_source == CurrentSource::torque;
    const float rated = by_torque ? settings.rated_torque_Nm : settings.rated_current_A;
    const bool reads = settings.gives_current && rated == 0.0F;
    if (reads && step-- == 0) {
        request = {by_torque ? object::rated_torque_mNm : object::rated_current_mA, 0, 0, 0};
        return true;
    }
    if (settings.heartbeat_period_ms != 0 && step-- == 0) {
        request = {object::producer_heartbeat_time_ms, 0, 2, settings.heartbeat_period_ms};
        return true;
    }
    for (std::uint16_t number = 0; settings.write_mapping && number < largest_pdo_count; ++number) {
        const PdoMapping& pdo = settings.pdos[number];
        const auto steps = static_cast<std::uint8_t>(pdo.is_used() ? steps_around_objects + pdo.mapped().size() : 0);
        if (step < steps) {
            request = mapping_step(pdo, number, step);
            return true;
        }
        step = static_cast<std::uint8_t>(step - steps);
    }
    return false;
}

}  // namespace millforce::cia402
