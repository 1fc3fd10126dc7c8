// SPDX-License-Identifier: Apache-2.0
#include "parameters/parameter_files.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string_view>
#include <type_traits>
#include <utility>

#include "files/input_error.hpp"
#include "files/toml_reader.hpp"
#include "parameters/bus_objects.hpp"
#include "parameters/local_io_reader.hpp"
#include "parameters/machine_bus.hpp"
#include "parameters/parameter_choices.hpp"
#include "parameters/parameter_table.hpp"

namespace millforce::host {

namespace {

using firmware::ParameterFile;

/// What stands in the field already is the default.
template <typename Field>
void read_field(const ParameterRow& row, TomlFile::Table& table, Field& field) {
    const std::optional<Field> fallback = row.is_required ? std::nullopt : std::optional(field);
    if constexpr (std::is_same_v<Field, bool>) {
        field = table.boolean(row.key, field);
    } else if constexpr (std::is_enum_v<Field>) {
        field = static_cast<Field>(table.choice(row.key, words_of(row.choices), static_cast<std::size_t>(field)));
    } else if constexpr (std::is_integral_v<Field>) {
        field = static_cast<Field>(table.integer(row.key, static_cast<std::int64_t>(row.minimum),
                                                 static_cast<std::int64_t>(row.maximum), fallback, row.unit));
    } else {
        field =
            static_cast<Field>(table.number(row.key, decimal(row.minimum), decimal(row.maximum), fallback, row.unit));
    }
}

// Far beyond any physical value, to keep infinity out.
constexpr double largest_information = 1e12;

void check_standard_error(const std::string& key, TomlFile::Table& table) {
    if (const std::string companion = key + "_se"; table.has(companion)) {
        table.number(companion, 0.0, largest_information);
    }
}

void check_information(const InformationRow& row, TomlFile::Table& table) {
    if (row.choices != nullptr) {
        table.choice(row.key, words_of(row.choices), 0);
    } else {
        table.number(row.key, -largest_information, largest_information, 0.0);
    }
}

/// Reads the rows of one file into `parameters`, or those of one of its tables.
template <typename Scalar>
class TableReader {
  public:
    TableReader(ParameterFile file, TomlFile::Table& root, firmware::Parameters<Scalar>& parameters)
        : file_(file), root_(root), parameters_(parameters) {}

    void read(std::string_view only_table = {}) {
        const auto is_asked = [&](const auto& row) {
            return row.file == file_ && (only_table.empty() || only_table == row.table);
        };
        const auto read_parameter = [&](const firmware::ParameterName& name, auto& field, float, float) {
            if (!is_asked(name)) {
                return;
            }
            const ParameterRow& row = row_of(name);
            TomlFile::Table& in = table(tables_in_file(row.table)[name.place]);
            read_field(row, in, field);
            if (row.type == ParameterType::number || row.type == ParameterType::integer) {
                check_standard_error(row.key, in);
            }
        };
        firmware::for_each_parameter(parameters_, read_parameter);
        for (const InformationRow& row : information_table()) {
            if (!is_asked(row)) {
                continue;
            }
            for (const char* name : tables_in_file(row.table)) {
                check_information(row, table(name));
                if (row.choices == nullptr) {
                    check_standard_error(row.key, table(name));
                }
            }
        }
    }

    /// After everything was read.
    void reject_unknown_keys() const {
        for (const auto& [name, table] : tables_) {
            table.reject_unknown_keys();
        }
    }

    /// "bus.x": the table [x] within [bus].
    TomlFile::Table& table(const std::string& name) {
        const auto found = tables_.find(name);
        if (found != tables_.end()) {
            return found->second;
        }
        const std::size_t dot = name.rfind('.');
        TomlFile::Table& parent = dot == std::string::npos ? root_ : table(name.substr(0, dot));
        return tables_.emplace(name, parent.table(name.substr(dot + 1))).first->second;
    }

  private:
    ParameterFile file_;
    TomlFile::Table& root_;
    firmware::Parameters<Scalar>& parameters_;
    std::map<std::string, TomlFile::Table> tables_;
};

struct MachineFileParts {
    BusObjects objects{};
    LocalIoKeys local{};
};

MachineFileParts read_file(ParameterFile file, TomlFile toml, firmware::Parameters<float>& parameters) {
    TomlFile::Table root = toml.root();
    root.text("name", "");  // free text: it belongs to the file, but to no algorithm
    root.text("description", "");
    TableReader<float> reader(file, root, parameters);
    reader.read();
    MachineFileParts parts;
    if (file == ParameterFile::machine) {
        for (std::size_t drive = 0; drive < parts.objects.size(); ++drive) {
            parts.objects[drive] = read_drive_objects(reader.table(drive_tables[drive]));
        }
        parts.local = read_local_io([&](const std::string& name) -> TomlFile::Table& { return reader.table(name); });
    }
    reader.reject_unknown_keys();
    root.reject_unknown_keys();
    return parts;
}

/// A limit of R_a without a prediction of it would hold the feed at its value on contact, without a visible reason.
void refuse_a_limit_that_cannot_be_kept(const std::string& path, const firmware::ToolParameters<float>& tool) {
    const estimation::RoughnessPredictor<float> predictor(tool.roughness);
    const bool is_Ra = tool.roughness.measure == estimation::RoughnessMeasure::Ra;
    if (tool.control.Ra_limit_um > 0.0F && !(predictor.has_interval() && is_Ra)) {
        throw InputError(
            fmt::format("{}: control.Ra_limit_um = {}: the file has no model of R_a with an interval; expected a "
                        "[roughness] table as "
                        "'millforce calibrate roughness --measure Ra' writes it, or 0",
                        path, tool.control.Ra_limit_um));
    }
}

}  // namespace

firmware::Parameters<float> read_parameters(const std::string& machine_path, const std::string& tool_path) {
    firmware::Parameters<float> parameters;
    parameters.machine = read_machine_parameters(machine_path);
    parameters.tool = read_tool_parameters(tool_path);
    return parameters;
}

firmware::MachineParameters<float> read_machine_parameters(const std::string& machine_path) {
    return machine_parameters_in(TomlFile::open(machine_path));
}

firmware::ToolParameters<float> read_tool_parameters(const std::string& tool_path) {
    return tool_parameters_in(TomlFile::open(tool_path));
}

firmware::MachineParameters<float> machine_parameters_in(TomlFile file) {
    firmware::Parameters<float> parameters;
    read_file(ParameterFile::machine, std::move(file), parameters);
    return parameters.machine;
}

firmware::ToolParameters<float> tool_parameters_in(TomlFile file) {
    const std::string path = file.path();
    firmware::Parameters<float> parameters;
    read_file(ParameterFile::tool, std::move(file), parameters);
    refuse_a_limit_that_cannot_be_kept(path, parameters.tool);
    return parameters.tool;
}

std::optional<MachineBus> read_machine_bus(const std::string& machine_path) {
    firmware::Parameters<float> parameters;
    const MachineFileParts parts = read_file(ParameterFile::machine, TomlFile::open(machine_path), parameters);
    return machine_bus(machine_path, parameters.machine, parts.objects, parts.local);
}

CuttingTable read_cutting_table(const std::string& tool_path) {
    TomlFile toml = TomlFile::open(tool_path);
    TomlFile::Table root = toml.root();
    if (!root.has("cutting")) {
        throw InputError(tool_path + ": no table [cutting]; expected the output of 'millforce calibrate cutting'");
    }
    firmware::Parameters<double> parameters;
    TableReader<double> reader(ParameterFile::tool, root, parameters);
    reader.read("cutting");
    reader.reject_unknown_keys();
    CuttingTable result{parameters.tool.law, std::nullopt};
    if (TomlFile::Table& table = reader.table("cutting"); table.has("cut_side")) {
        result.side =
            table.choice("cut_side", {"down", "up"}) == 1 ? estimation::CutSide::up : estimation::CutSide::down;
    }
    return result;
}

}  // namespace millforce::host
