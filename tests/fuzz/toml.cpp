// SPDX-License-Identifier: Apache-2.0
// A TOML file, read as each of the files that a user writes: machine, tool, scenario, kind of machine, map of an
// import.
#include <sstream>

#include "files/toml_reader.hpp"
#include "firmware/parameters_in.hpp"
#include "fuzz/hostile_bytes.hpp"
#include "import/import_map.hpp"
#include "loop/machine_kind.hpp"
#include "loop/scenario.hpp"
#include "parameters/machine_bus.hpp"
#include "parameters/parameter_block_file.hpp"
#include "parameters/parameter_files.hpp"

using namespace millforce;

namespace {

/// Beside it lie the machine and the tool that a scenario may name.
std::string written(std::string_view text) {
    static const bool is_prepared = [] {
        for (const char* name : {"machines", "tools"}) {
            std::filesystem::copy(std::filesystem::path(MILLFORCE_SOURCE_DIR "/sim/scenarios") / name,
                                  fuzz::folder().path(name));
        }
        return true;
    }();
    (void)is_prepared;
    return fuzz::folder().write("input.toml", text).string();
}

void require_in_range(const firmware::Parameters<float>& parameters) {
    firmware::for_each_parameter(parameters, [](const auto&, const auto& field, float minimum, float maximum) {
        const auto value = static_cast<float>(field);
        fuzz::require(value >= minimum && value <= maximum, "a value within its range");
    });
    firmware::Parameters<float> again;
    fuzz::require(firmware::decode(firmware::encoded(parameters, 1), again) == firmware::BlockError::none,
                  "a flash takes what the file gives");
}

/// As `millforce parameters --read-block` prints them. The tool's part stands behind the machine's.
void require_printed_as_read(const firmware::Parameters<float>& parameters) {
    std::ostringstream text;
    host::write_parameters_as_toml(text, {parameters.machine, {{0, parameters.tool}}});
    const std::string both = text.str();
    const std::size_t tool = both.find("# tool.toml");
    const auto machine_file = fuzz::folder().write("printed_machine.toml", both.substr(0, tool));
    const auto tool_file = fuzz::folder().write("printed_tool.toml", both.substr(tool));
    const auto again = host::read_parameters(machine_file.string(), tool_file.string());
    fuzz::require(firmware::values_of(again) == firmware::values_of(parameters),
                  "parameters that are printed are read back");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(fuzz::text_of({data, size}));
    if (!fuzz::is_taken([&] { (void)host::TomlFile::from_text(text, "input.toml"); })) {
        return 0;
    }
    const std::string file = written(text);
    static const firmware::Parameters<float> of_a_machine =
        host::read_parameters(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml",
                              MILLFORCE_SOURCE_DIR "/sim/scenarios/tools/endmill_10mm.toml");
    firmware::Parameters<float> parameters = of_a_machine;
    const bool is_machine = fuzz::is_taken([&] {
        (void)host::read_machine_bus(file);
        parameters.machine = host::read_machine_parameters(file);
    });
    const bool is_tool = fuzz::is_taken([&] { parameters.tool = host::read_tool_parameters(file); });
    if (is_machine || is_tool) {
        require_in_range(parameters);
        require_printed_as_read(parameters);
    }
    fuzz::is_taken([&] { (void)host::read_cutting_table(file); });
    fuzz::is_taken([&] { (void)sim::read_scenario(file); });
    fuzz::is_taken([&] { (void)sim::read_machine_kind(file); });
    fuzz::is_taken([&] { (void)host::read_import_map(file); });
    return 0;
}
