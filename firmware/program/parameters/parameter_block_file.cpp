// SPDX-License-Identifier: Apache-2.0
#include "parameters/parameter_block_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <string_view>
#include <type_traits>

#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
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

void write_parameters_as_toml(std::ostream& out, const firmware::Parameters<float>& parameters) {
    TomlWriter writer(out);
    writer.comment("machine.toml");
    write_file(writer, firmware::ParameterFile::machine, parameters);
    writer.comment("tool.toml");
    write_file(writer, firmware::ParameterFile::tool, parameters);
}

}  // namespace millforce::host
