// SPDX-License-Identifier: Apache-2.0
#include "parameters/parameter_block_file.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <string_view>
#include <type_traits>

#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "files/text_lines.hpp"
#include "files/toml_writer.hpp"
#include "parameters/parameter_choices.hpp"
#include "parameters/parameter_table.hpp"

namespace millforce::host {

namespace {

template <typename Field>
void write_value(TomlWriter& writer, const ParameterRow& row, Field field) {
    if constexpr (std::is_same_v<Field, bool>) {
        writer.flag_key(row.key, field);
    } else if constexpr (std::is_enum_v<Field>) {
        writer.key(row.key, words_of(row.choices)[static_cast<std::size_t>(field)]);
    } else if constexpr (std::is_integral_v<Field>) {
        writer.integer_key(row.key, field);
    } else {
        writer.key(row.key, decimal(field));
    }
}

void write_file(TomlWriter& writer, firmware::ParameterFile file, const firmware::Parameters<float>& parameters) {
    std::string_view written;
    firmware::for_each_parameter(parameters, [&](const firmware::ParameterName& name, const auto& field, float, float) {
        if (name.file != file) {
            return;
        }
        const ParameterRow& row = row_of(name);
        const std::string_view table = tables_in_file(row.table)[name.place];
        if (table != written) {
            writer.table(table);
            written = table;
        }
        write_value(writer, row, field);
    });
}

void write_bytes(const std::string& path, std::span<const std::uint8_t> bytes) {
    AtomicFile file(path);
    for (const std::uint8_t byte : bytes) {
        file.stream().put(static_cast<char>(byte));
    }
    file.commit();
}

/// The longest block and one tool more, so that too many tools are called so.
constexpr std::size_t most_bytes = firmware::largest_block_bytes + firmware::numbered_tool_bytes;

}  // namespace

void write_parameter_block(const std::string& path, const firmware::Parameters<float>& parameters) {
    write_bytes(path, firmware::encoded(parameters, 1));
}

std::size_t write_tools_block(const std::string& path, const firmware::MachineParameters<float>& machine,
                              std::span<const firmware::NumberedTool> tools) {
    if (tools.empty() || tools.size() > firmware::largest_tool_count) {
        throw InputError(
            fmt::format("{}: {} tools, expected 1 to {} in a block", path, tools.size(), firmware::largest_tool_count));
    }
    firmware::LargestParameterBlock block{};
    const std::span<const std::uint8_t> used = firmware::encode_tools(machine, tools, 1, block);
    write_bytes(path, used);
    return used.size();
}

BlockContents read_parameter_block(const std::string& path) {
    std::ifstream file = open_to_read(path);
    std::array<std::uint8_t, most_bytes> block{};
    file.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size()));
    const std::span<const std::uint8_t> bytes =
        std::span<const std::uint8_t>(block).first(static_cast<std::size_t>(file.gcount()));
    firmware::Parameters<float> parameters;
    const firmware::BlockError error = firmware::decode(bytes, parameters);
    if (error != firmware::BlockError::none) {
        throw InputError(
            fmt::format("{}: {}; expected a block as 'millforce parameters --write-block' of this version writes it",
                        path, firmware::name(error)));
    }
    const firmware::BlockTools tools = firmware::tools_of(bytes);
    BlockContents contents{parameters.machine, std::vector<firmware::NumberedTool>(tools.size())};
    for (std::size_t place = 0; place < tools.size(); ++place) {
        contents.tools[place].number = tools.number_at(place);
        (void)tools.read_at(place, contents.tools[place].parameters);  // its values were checked with the block
    }
    if (contents.tools.empty()) {
        contents.tools.push_back({0, parameters.tool});
    }
    return contents;
}

void write_parameters_as_toml(std::ostream& out, const BlockContents& contents) {
    TomlWriter writer(out);
    writer.comment("machine.toml");
    write_file(writer, firmware::ParameterFile::machine, {contents.machine, {}});
    for (const firmware::NumberedTool& tool : contents.tools) {
        writer.comment(tool.number == 0 ? std::string("tool.toml") : fmt::format("T{}.toml", tool.number));
        write_file(writer, firmware::ParameterFile::tool, {contents.machine, tool.parameters});
    }
}

}  // namespace millforce::host
