// SPDX-License-Identifier: Apache-2.0
#include "parameters/bus_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "cia402/objects.hpp"
#include "files/input_error.hpp"
#include "parameters/parameter_table.hpp"

namespace millforce::host {

namespace {

using cia402::MappedObject;
using cia402::SettingsError;

/// Hexadecimal with 0x, else decimal; nothing if it is not a number up to `largest`.
std::optional<std::uint32_t> whole_number(std::string_view text, std::uint32_t largest) {
    const bool is_hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    text.remove_prefix(is_hexadecimal ? 2 : 0);
    std::uint32_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value, is_hexadecimal ? 16 : 10);
    return error == std::errc() && stopped == end && value <= largest ? std::optional(value) : std::nullopt;
}

/// "0x6064" or "0x60FE.1".
std::optional<cia402::ObjectAddress> address_of(std::string_view text) {
    const std::size_t dot = text.find('.');
    const auto index = whole_number(text.substr(0, dot), 0xFFFF);
    const auto subindex = dot == std::string_view::npos ? std::optional(0U) : whole_number(text.substr(dot + 1), 0xFF);
    if (!index || *index == 0 || !subindex) {
        return std::nullopt;
    }
    return cia402::ObjectAddress{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*subindex)};
}

/// "0x6064:32".
std::optional<MappedObject> mapped_object_of(std::string_view text) {
    const std::size_t colon = text.find(':');
    const auto address = address_of(text.substr(0, colon));
    const std::string_view width = colon == std::string_view::npos ? std::string_view() : text.substr(colon + 1);
    const std::uint32_t bits = whole_number(width, 64).value_or(0);
    if (!address || bits == 0) {
        return std::nullopt;
    }
    return MappedObject{address->index, address->subindex, static_cast<std::uint8_t>(bits)};
}

void read_mapping(TomlFile::Table& table, const std::string& key, cia402::PdoMapping& pdo) {
    const std::vector<std::string> texts = table.texts(key);
    if (texts.size() > cia402::largest_pdo_objects) {
        table.fail(key, fmt::format("{} objects, expected at most {}", texts.size(), cia402::largest_pdo_objects));
    }
    unsigned bits = 0;
    for (const std::string& text : texts) {
        const auto object = mapped_object_of(text);
        if (!object) {
            table.fail(key, fmt::format("\"{}\" is no object, expected INDEX:BITS or INDEX.SUBINDEX:BITS with 1 to 64 "
                                        "bits, e.g. \"0x6064:32\"",
                                        text));
        }
        bits += object->bits;
        pdo.objects[pdo.object_count++] = *object;
    }
    if (bits > 64) {
        table.fail(key, fmt::format("{} bits, expected at most 64", bits));
    }
}

cia402::ObjectAddress read_address(TomlFile::Table& table, const std::string& key, cia402::ObjectAddress fallback) {
    const std::string text = table.text(key, "");
    if (text.empty()) {
        return fallback;
    }
    const auto address = address_of(text);
    if (!address) {
        table.fail(key, "expected an object as INDEX or INDEX.SUBINDEX, e.g. \"0x6064\"");
    }
    return *address;
}

[[noreturn]] void refuse_local(const std::string& file, std::size_t place, const std::string& what) {
    throw InputError(fmt::format("{}: {}: {}", file, local_drive_tables[place], what));
}

bool maps(const cia402::DriveSettings& drive, std::uint16_t index) {
    for (const cia402::PdoMapping& pdo : drive.pdos) {
        for (const MappedObject& object : pdo.mapped()) {
            if (object.index == index) {
                return true;
            }
        }
    }
    return false;
}

/// The current of this drive, and its motion where it has a counter, come by this computer's own inputs. Where no PDO
/// is left the drive is not on the bus.
void take_from_bus(const std::string& file, std::size_t place, const LocalDriveKeys& keys,
                   cia402::DriveSettings& drive) {
    const char* table = drive_tables[place];
    const std::uint16_t motion = place == 0 ? drive.count_object.index : cia402::object::velocity_actual;
    if (maps(drive, cia402::object::current_actual) || (keys.has_counter() && maps(drive, motion))) {
        refuse_local(file, place, fmt::format("a tpdo of [{}] gives the same, expected one of the two", table));
    }
    const bool has_pdo = std::ranges::any_of(drive.pdos, [](const cia402::PdoMapping& pdo) { return pdo.is_used(); });
    const bool is_on_bus = drive.node_id != 0 && has_pdo;
    if (!is_on_bus && !keys.has_counter()) {
        refuse_local(file, place,
                     fmt::format("its motion is missing, expected count_file, or node_id and tpdo1 in [{}]", table));
    }
    drive.node_id = is_on_bus ? drive.node_id : std::uint8_t{0};
    drive.gives_current = false;
    drive.gives_motion = !keys.has_counter();
}

std::uint8_t given_by(std::size_t place, const LocalDriveKeys& keys) {
    const std::uint8_t count = keys.has_counter() ? hal::mask(hal::Present::spindle_count) : std::uint8_t{0};
    return place == 0 ? static_cast<std::uint8_t>(hal::mask(hal::Present::spindle_current) | count)
                      : hal::axis_mask(place - 1);
}

/// What is wrong, and what was expected.
const char* explanation(SettingsError error) {
    switch (error) {
        case SettingsError::none:
            return "nothing is wrong";
        case SettingsError::no_drive:
            return "no drive, expected a node_id";
        case SettingsError::node_id:
            return "node_id is used twice, expected another for each drive";
        case SettingsError::pdo_mapping:
            return "tpdo1 … tpdo4: expected CAN ids from 0x181 to 0x57F and at most 64 bits";
        case SettingsError::id_used_twice:
            return "a CAN id is used twice, expected another for each PDO and SYNC";
        case SettingsError::object_missing:
            return "a needed object is in none of tpdo1 … tpdo4, expected 0x6078 (or 0x6077 with current_source = "
                   "\"torque\"), and count_object and the index objects of the spindle, or 0x606C (or 0x6064 with "
                   "velocity_source = \"position\") of an axis";
        case SettingsError::object_width:
            return "an object that is read has more than 32 bits";
        case SettingsError::rated_value:
            return "no rated value, and a listener cannot ask the drive; expected rated_current_A in the drive's own "
                   "table, or rated_torque_Nm here";
        case SettingsError::torque_constant:
            return "torque_constant_Nm_per_A = 0, expected a positive one with current_source = \"torque\"";
        case SettingsError::unit:
            return "velocity_mm_s_per_unit = 0, or position_mm_per_unit with velocity_source = \"position\"; expected "
                   "the unit of the object";
        case SettingsError::limit:
            return "count_modulus or largest_count_step, expected steps of at most half the modulus";
        case SettingsError::heartbeat:
            return "heartbeat_timeout_ms, expected more than heartbeat_period_ms";
        case SettingsError::sync:
            return "collect_time_ms, expected at most sync_period_ms";
    }
    return "";
}

[[noreturn]] void refuse(const std::string& file, const char* table, SettingsError error) {
    throw InputError(fmt::format("{}: {}: {}", file, table, explanation(error)));
}

/// Each drive alone first: the message can name its table then.
void check_bus(const std::string& file, const cia402::BusSettings& settings) {
    for (std::size_t k = 0; k < settings.drives.size(); ++k) {
        cia402::BusSettings alone = settings;
        alone.drives = {};
        alone.drives[k] = settings.drives[k];
        const SettingsError error = settings.drives[k].node_id == 0 ? SettingsError::none : check(alone);
        if (error != SettingsError::none) {
            refuse(file, error == SettingsError::sync ? "bus" : drive_tables[k], error);
        }
    }
    if (const SettingsError error = check(settings); error != SettingsError::none) {
        refuse(file, "bus", error);
    }
}

}  // namespace

DriveObjects read_drive_objects(TomlFile::Table& table) {
    DriveObjects objects;
    for (std::size_t k = 0; k < objects.pdos.size(); ++k) {
        read_mapping(table, fmt::format("tpdo{}", k + 1), objects.pdos[k]);
    }
    objects.count = read_address(table, "count_object", objects.count);
    objects.index_count = read_address(table, "index_count_object", {});
    objects.index_number = read_address(table, "index_number_object", {});
    return objects;
}

std::optional<MachineBus> machine_bus(const std::string& file, const firmware::MachineParameters<float>& machine,
                                      const BusObjects& objects, const LocalIoKeys& local) {
    firmware::CanControllerSettings settings = firmware::can_controller_settings(machine, objects);
    for (std::size_t k = 0; k < local.drives.size(); ++k) {
        if (local.drives[k].is_used()) {
            take_from_bus(file, k, local.drives[k], settings.drives.drives[k]);
            settings.drives.beside_bus =
                static_cast<std::uint8_t>(settings.drives.beside_bus | given_by(k, local.drives[k]));
        }
    }
    const auto is_used = [](const cia402::DriveSettings& drive) { return drive.node_id != 0; };
    if (std::ranges::none_of(settings.drives.drives, is_used) && settings.drives.beside_bus == 0) {
        return std::nullopt;
    }
    check_bus(file, settings.drives);
    return MachineBus{settings.drives, settings.produces_sync, settings.feed_override, settings.program, local};
}

}  // namespace millforce::host
