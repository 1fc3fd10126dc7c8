// SPDX-License-Identifier: Apache-2.0
#include "parameters/machine_bus.hpp"
#include "files/input_error.hpp"
#include "parameters/parameter_files.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

const std::string spindle = "[spindle]\nK_t1_Nm_per_A = 0.7\nrated_current_A = 12\n";

const std::string bus = spindle + R"([bus]
role = "master"
sync_id = 0x81
[bus.spindle]
node_id = 5
tpdo1 = ["0x6064:32", "0x6078:16"]
tpdo3 = ["0x60FE.1:16", "24762:32", "0x60D5:16"]
tpdo3_id = 0x3A0
tpdo3_every = 0
index_count_object = "0x60BA"
index_number_object = "0x60D5"
[bus.x]
node_id = 6
tpdo1 = ["0x6041:16", "0x606C:32", "0x6077:16"]
current_source = "torque"
current_basis = "peak"
torque_constant_Nm_per_A = 0.6
velocity_mm_s_per_unit = -0.002
stale_ms = 7.5
)";

std::optional<MachineBus> read(const std::string& text) {
    const TemporaryFolder folder;
    return read_machine_bus(folder.write("machine.toml", text).string());
}

std::string error_of(const std::string& from, const std::string& to) {
    std::string text = bus;
    text.replace(text.find(from), from.size(), to);
    return message_of<InputError>([&] { read(text); });
}

}  // namespace

TEST_GROUP(MachineBusFile){};

TEST(MachineBusFile, a_machine_without_drives_on_a_bus_has_none) {
    CHECK_FALSE(read(spindle).has_value());
    CHECK_FALSE(read(spindle + "[bus]\nrole = \"master\"\n").has_value());
}

TEST(MachineBusFile, every_mapping_order_width_and_unit_arrives_as_written) {
    const MachineBus read_bus = read(bus).value();
    const cia402::DriveSettings& drive = read_bus.drives.drives[0];
    CHECK(read_bus.drives.is_master);
    CHECK_FALSE(read_bus.produces_sync);
    UNSIGNED_LONGS_EQUAL(0x81, read_bus.drives.sync_id);
    UNSIGNED_LONGS_EQUAL(1000, read_bus.drives.sync_period_us);
    UNSIGNED_LONGS_EQUAL(0x185, drive.pdos[0].id);
    UNSIGNED_LONGS_EQUAL(0, drive.pdos[1].id);
    UNSIGNED_LONGS_EQUAL(0x3A0, drive.pdos[2].id);
    UNSIGNED_LONGS_EQUAL(254, drive.pdos[2].transmission_type);
    UNSIGNED_LONGS_EQUAL(3, drive.pdos[2].object_count);
    CHECK((drive.pdos[2].objects[0] == cia402::MappedObject{0x60FE, 1, 16}));
    CHECK((drive.pdos[2].objects[1] == cia402::MappedObject{0x60BA, 0, 32}));
    DOUBLES_EQUAL(12.0, drive.rated_current_A, 0.0);
    const cia402::DriveSettings& x = read_bus.drives.drives[1];
    CHECK(x.current_source == cia402::CurrentSource::torque);
    CHECK(x.current_basis == cia402::CurrentBasis::peak);
    DOUBLES_EQUAL(-0.002, x.velocity_mm_s_per_unit, 1e-9);
    UNSIGNED_LONGS_EQUAL(7500, x.stale_us);
    UNSIGNED_LONGS_EQUAL(0, read_bus.drives.drives[2].node_id);
}

TEST(MachineBusFile, an_object_that_is_none_is_named_with_its_place) {
    const std::string expected = "is no object, expected INDEX:BITS or INDEX.SUBINDEX:BITS with 1 to 64 bits";
    for (const char* wrong : {"0x6064", "0x6064:0", "0x6064:65", "0x10000:8", "0x6064.256:8", "position:32", ":32",
                              "0x6064:32x", "0:16", "-1:16", ""}) {
        const std::string message = error_of("0x6064:32", wrong);
        CHECK_TEXT(contains(message, std::string("\"") + wrong + "\" " + expected), message.c_str());
        CHECK(contains(message, "machine.toml:9:"));
        CHECK(contains(message, "bus.spindle.tpdo1"));
    }
    CHECK(contains(error_of("\"0x6064:32\"", "6"), "element 1 is 6, expected a text in quotes"));
    CHECK(contains(error_of("[\"0x6064:32\", \"0x6078:16\"]", "\"0x6064:32\""), "expected an array of texts"));
    CHECK(contains(error_of("\"0x60BA\"", "\"0x60BG\""), "index_count_object = \"0x60BG\": expected an object"));
}

TEST(MachineBusFile, more_than_a_frame_holds_is_refused) {
    CHECK(contains(error_of("\"0x6078:16\"]", "\"0x6078:16\", \"0x6041:32\"]"), "80 bits, expected at most 64"));
    CHECK(contains(
        error_of("\"0x6064:32\", ", "\"0x1:1\",\"0x2:1\",\"0x3:1\",\"0x4:1\",\"0x5:1\",\"0x6:1\",\"0x7:1\",\"0x8:1\","),
        "9 objects, expected at most 8"));
}

TEST(MachineBusFile, settings_that_do_not_fit_together_are_told_with_their_table) {
    CHECK(contains(error_of("\"0x606C:32\", ", ""), "machine.toml: bus.x: a needed object is in none of tpdo1"));
    CHECK(contains(error_of("node_id = 6", "node_id = 5"), "bus: node_id is used twice"));
    CHECK(contains(error_of("0.6", "0"), "bus.x: torque_constant_Nm_per_A = 0"));
    CHECK(contains(error_of("velocity_mm_s_per_unit = -0.002", ""), "bus.x: velocity_mm_s_per_unit = 0"));
    CHECK(contains(error_of("sync_id = 0x81", "collect_time_ms = 2"), "bus: collect_time_ms, expected at most"));
    CHECK(contains(error_of("tpdo3_id = 0x3A0", "tpdo3_id = 0x185"), "bus.spindle: a CAN id is used twice"));
    CHECK(contains(error_of("0x6064:32", "0x6064:48"), "bus.spindle: an object that is read has more than 32 bits"));
    CHECK(contains(error_of("stale_ms", "heartbeat_period_ms = 500\nheartbeat_timeout_ms = 400\nstale_ms"),
                   "bus.x: heartbeat_timeout_ms, expected more than heartbeat_period_ms"));
    CHECK(contains(error_of("tpdo3_every", "largest_count_step = 10\ncount_modulus = 12\ntpdo3_every"),
                   "bus.spindle: count_modulus or largest_count_step, expected steps of at most half the modulus"));
    CHECK(contains(error_of("role = \"master\"", ""), "bus.x: no rated value, and a listener cannot ask"));
}

TEST(MachineBusFile, an_unknown_key_names_the_nearest) {
    CHECK(contains(error_of("stale_ms", "stale_us"), "bus.x.stale_us: unknown key; did you mean stale_ms?"));
    CHECK(contains(error_of("tpdo3_every", "tpdo3_evry"), "did you mean tpdo3_every?"));
    CHECK(contains(error_of("[bus.x]", "[bus.w]"), "bus.w: unknown key"));
    CHECK(contains(error_of("role", "rolle"), "did you mean role?"));
}

TEST(MachineBusFile, is_documented_key_by_key) {
    const std::string text = parameter_documentation();
    for (const char* part : {"### [bus]\n", "### [bus.spindle], [bus.x], [bus.y], [bus.z]\n", "| `tpdo4_every` |",
                             "| `index_number_object` | `\"0x60D5\"` | none |", "listener, master"}) {
        CHECK_TEXT(contains(text, part), part);
    }
}

namespace {

/// The spindle's current by a converter and its angle by a counter; of x the current alone, beside the drive's
/// velocity.
const std::string local = spindle + R"([bus]
produces_sync = true
[bus.spindle]
node_id = 5
[bus.x]
node_id = 6
tpdo1 = ["0x6041:16", "0x606C:32"]
velocity_mm_s_per_unit = -0.002
heartbeat_timeout_ms = 500
[iio]
device = "/sys/bus/iio/devices/iio:device0"
mode = "polled"
[iio.spindle]
current_channel = "voltage0"
A_per_V = 10
count_file = "/sys/bus/counter/devices/counter0/count0/count"
[iio.x]
current_channel = "voltage3"
A_per_V = -2
largest_A = 40
[override_voltage]
device = "/sys/bus/iio/devices/iio:device1"
channel = "voltage0"
)";

std::string local_error(const std::string& from, const std::string& to) {
    std::string text = local;
    text.replace(text.find(from), from.size(), to);
    return message_of<InputError>([&] { read(text); });
}

}  // namespace

TEST_GROUP(LocalIoFile){};

TEST(LocalIoFile, a_motor_with_a_converter_and_a_counter_is_not_on_the_bus_and_one_without_counter_keeps_its_pdos) {
    const MachineBus machine = read(local).value();
    UNSIGNED_LONGS_EQUAL(0, machine.drives.drives[0].node_id);
    const unsigned given =
        hal::mask(hal::Present::spindle_count) | hal::mask(hal::Present::spindle_current) | hal::axis_mask(0);
    UNSIGNED_LONGS_EQUAL(given, machine.drives.beside_bus);
    const cia402::DriveSettings& x_drive = machine.drives.drives[1];
    UNSIGNED_LONGS_EQUAL(6, x_drive.node_id);
    CHECK_FALSE(x_drive.gives_current);
    CHECK(x_drive.gives_motion);
    DOUBLES_EQUAL(-0.002, x_drive.velocity_mm_s_per_unit, 1e-9);  // of the drive's own PDO
    UNSIGNED_LONGS_EQUAL(500'000, x_drive.heartbeat_timeout_us);
    CHECK(machine.local.has_voltage());
    CHECK_FALSE(machine.local.has_lines());
}

TEST(LocalIoFile, what_is_missing_or_told_twice_is_named_with_its_table_and_key) {
    STRCMP_CONTAINS("iio.x.current_channel", local_error("current_channel = \"voltage3\"\n", "").c_str());
    STRCMP_CONTAINS("iio.spindle.A_per_V", local_error("A_per_V = 10\n", "").c_str());
    STRCMP_CONTAINS("iio.buffer: is missing", local_error("mode = \"polled\"\n", "").c_str());
    STRCMP_CONTAINS("[iio] device", local_error("device = \"/sys/bus/iio/devices/iio:device0\"\n", "").c_str());
    STRCMP_CONTAINS("iio.x: a tpdo of [bus.x] gives the same",
                    local_error("\"0x606C:32\"]", "\"0x606C:32\", \"0x6078:16\"]").c_str());
    STRCMP_CONTAINS("iio.x: its motion is missing", local_error("node_id = 6\n", "").c_str());
    STRCMP_CONTAINS("bus.x: a needed object is in none of tpdo1", local_error(", \"0x606C:32\"", "").c_str());
    STRCMP_CONTAINS("did you mean largest_A?", local_error("A_per_V = 10", "A_per_V = 10\nlargest_a = 9").c_str());
    STRCMP_CONTAINS("override_voltage.channel",
                    local_error("iio:device1\"\nchannel = \"voltage0\"", "iio:device1\"").c_str());
}
