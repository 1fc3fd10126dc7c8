// SPDX-License-Identifier: Apache-2.0
#include "files/parameter_block_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string_view>
#include <vector>

#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "files/parameter_choices.hpp"
#include "files/toml_writer.hpp"

namespace millforce::host {

namespace {

using Row = firmware::ParameterRow<float>;

void write_value(TomlWriter& writer, const Row& row, float value) {
    if (row.choices != nullptr) {
        writer.key(row.key, words_of(row.choices)[static_cast<std::size_t>(value)]);
    } else {
        writer.key(row.key, decimal(value));
    }
}

/// The rows of one table, in the order of the parameter table.
void write_table(TomlWriter& writer, firmware::ParameterFile file, std::string_view table, std::size_t axis,
                 firmware::Parameters<float>& parameters) {
    writer.table(table == "axis"        ? firmware::axis_tables[axis]
                 : table == "bus.drive" ? firmware::drive_tables[axis]
                                        : table);
    for (const Row& row : firmware::parameter_table<float>) {
        if (row.file == file && row.table == table) {
            write_value(writer, row, row.field(parameters, axis));
        }
    }
}

void write_file(TomlWriter& writer, firmware::ParameterFile file, firmware::Parameters<float>& parameters) {
    std::vector<std::string_view> written;
    for (const Row& row : firmware::parameter_table<float>) {
        const std::string_view table = row.table;
        if (row.file != file || std::find(written.begin(), written.end(), table) != written.end()) {
            continue;
        }
        written.push_back(table);
        for (std::size_t axis = 0; axis < firmware::axes_of(row.table); ++axis) {
            write_table(writer, file, table, axis, parameters);
        }
    }
}

}  // namespace

void write_parameter_block(const std::string& path, const firmware::Parameters<float>& parameters) {
    const firmware::ParameterBlock block = firmware::encoded(parameters, 1);
    AtomicFile file(path);
    for (const std::uint8_t byte : block) {
        file.stream().put(static_cast<char>(byte));
    }
    file.commit();
}

firmware::Parameters<float> read_parameter_block(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw InputError(fmt::format("{}: no such file", path));
    }
    firmware::ParameterBlock block{};
    file.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size()));
    const auto count = static_cast<std::size_t>(file.gcount());
    firmware::Parameters<float> parameters;
    const firmware::BlockError error = firmware::decode(std::span<const std::uint8_t>(block).first(count), parameters);
    if (error != firmware::BlockError::none) {
        throw InputError(
            fmt::format("{}: {}; expected a block of {} bytes as 'millforce parameters --write-block' of this "
                        "version writes it",
                        path, firmware::name(error), block.size()));
    }
    return parameters;
}

void write_parameters_as_toml(std::ostream& out, firmware::Parameters<float> parameters) {
    TomlWriter writer(out);
    writer.comment("machine.toml");
    write_file(writer, firmware::ParameterFile::machine, parameters);
    writer.comment("tool.toml");
    write_file(writer, firmware::ParameterFile::tool, parameters);
}

}  // namespace millforce::host
