// SPDX-License-Identifier: Apache-2.0
#include "import/import_map.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "files/input_error.hpp"
#include "files/printable.hpp"
#include "files/toml_reader.hpp"
#include "import/text_cells.hpp"

namespace millforce::host {

namespace {

using Table = TomlFile::Table;

constexpr double largest_factor = 1e12;
constexpr std::int64_t most_columns = 10'000;

struct DerivedWord {
    Quantity column;
    const char* word;
    Derivation derivation;
    Quantity source;
};

constexpr std::array derived_words{
    DerivedWord{Quantity::velocity, "position", Derivation::position, Quantity::position},
    DerivedWord{Quantity::angle, "speed", Derivation::speed, Quantity::speed},
    DerivedWord{Quantity::angle, "index", Derivation::index, Quantity::pulse},
};

/// Sets what is derived; returns what the source measures.
Quantity read_derivation(Table& table, ColumnMap& column) {
    std::vector<std::string> words;
    std::vector<DerivedWord> known;
    for (const DerivedWord& one : derived_words) {
        if (one.column == column.column.quantity) {
            words.emplace_back(one.word);
            known.push_back(one);
        }
    }
    if (words.empty() || !table.has("derived_from")) {
        return column.column.quantity;
    }
    const DerivedWord& chosen = known[table.choice("derived_from", words)];
    column.derived_from = chosen.derivation;
    return chosen.source;
}

double read_needed(Table& table, const Unit& unit, UnitNeed need, const char* key) {
    return unit.needs_setting(need) ? table.number(key, 1e-9, largest_factor) : 0.0;
}

UnitSettings read_unit_settings(Table& table, const Unit& unit) {
    return {read_needed(table, unit, UnitNeed::rated_A, "rated_A"),
            read_needed(table, unit, UnitNeed::counts_per_rev, "counts_per_rev"),
            read_needed(table, unit, UnitNeed::screw_pitch_mm, "screw_pitch_mm"),
            read_needed(table, unit, UnitNeed::rate_hz, "rate_hz")};
}

double read_sign(Table& table) {
    const std::int64_t sign = table.integer("sign", -1, 1, 1);
    if (sign == 0) {
        table.fail("sign", "expected 1 or -1");
    }
    return static_cast<double>(sign);
}

void read_source_name(Table& table, SourceName& source) {
    if (table.has("source_number")) {
        source.number = static_cast<std::size_t>(table.integer("source_number", 1, most_columns));
        if (table.has("source")) {
            table.fail("source", "expected either source or source_number");
        }
        return;
    }
    source.name = without_spaces(table.text("source"));
    if (source.name.empty()) {
        table.fail("source", "expected the name of a column");
    }
}

void read_threshold(Table& table, ColumnMap& column) {
    column.threshold = table.number("threshold", -largest_factor, largest_factor, column.threshold);
}

void read_state(Table& table, ColumnMap& column) {
    column.unit = unit_names(Quantity::state).front();
    if (!table.has("equals")) {
        read_threshold(table, column);
        return;
    }
    if (table.has("threshold")) {
        table.fail("threshold", "expected either equals or threshold");
    }
    column.equals = table.number("equals", -largest_factor, largest_factor);
}

void read_unit(Table& table, Quantity quantity, ColumnMap& column) {
    const std::vector<std::string> names = unit_names(quantity);
    const Unit& unit = unit_of(quantity, table.choice("unit", names, std::size_t{0}));
    column.unit = unit.name;
    column.factor = read_sign(table) * table.number("scale", -largest_factor, largest_factor, 1.0) *
                    unit.to_ours(read_unit_settings(table, unit));
    if (column.factor == 0.0) {
        table.fail("scale", "expected a factor that is not 0");
    }
}

void read_measured(Table& table, ColumnMap& column) {
    const Quantity measured = read_derivation(table, column);
    read_unit(table, measured, column);
    if (measured != Quantity::time) {  // a recording begins at 0
        column.offset = table.number("offset", -largest_factor, largest_factor, 0.0);
    }
    if (measured == Quantity::angle || measured == Quantity::position || measured == Quantity::time) {
        column.wrap = table.number("wrap", 0.0, largest_factor, 0.0);
    }
    if (column.derived_from == Derivation::position) {
        column.smoothing_s = table.number("smoothing_s", 1e-6, 1.0, 0.01, "s");
    }
    if (column.derived_from == Derivation::index) {
        read_threshold(table, column);
    }
}

ColumnMap read_column(Table& table, const RecordingColumn& target) {
    ColumnMap column;
    column.column = target;
    read_source_name(table, column.source);
    if (target.quantity == Quantity::state) {
        read_state(table, column);
    } else {
        read_measured(table, column);
    }
    table.reject_unknown_keys();
    return column;
}

void read_time(Table& table, ImportMap& map) {
    if (table.has("source") || table.has("source_number")) {
        map.time = read_column(table, recording_columns().front());
        return;
    }
    map.sample_rate_hz = table.number("rate_hz", 1e-3, 1e9, {}, "Hz");
    table.reject_unknown_keys();
}

void read_source(Table table, ImportMap& map) {
    // In the order of the enumerators, without `detected`.
    const std::vector<std::string> formats{"csv", "odrive", "sinumerik", "halsampler", "candump"};
    if (table.has("format")) {
        map.format = static_cast<SourceFormat>(table.choice("format", formats) + 1);
    }
    map.names = table.texts("names");
    map.interface = table.text("interface", "");
    const std::filesystem::path dbc = table.text("dbc", "");
    if (!dbc.empty()) {
        map.dbc = (std::filesystem::path(map.file).parent_path() / dbc).string();
    }
    table.reject_unknown_keys();
}

}  // namespace

std::string SourceName::shown() const {
    return number > 0 ? fmt::format("column {}", number) : printable(name);
}

ImportMap read_import_map(const std::string& file) {
    TomlFile toml = TomlFile::open(file);
    Table root = toml.root();
    ImportMap map;
    map.file = file;
    read_source(root.table("source"), map);
    for (const RecordingColumn& target : recording_columns()) {
        Table table = root.table(std::string(target.name));
        if (!table.exists()) {
            continue;
        }
        if (target.quantity == Quantity::time) {
            read_time(table, map);
        } else {
            map.columns.push_back(read_column(table, target));
        }
    }
    root.reject_unknown_keys();
    if (map.columns.empty()) {
        throw InputError(fmt::format("{}: no column of a recording; expected tables such as [x_current_A]", file));
    }
    return map;
}

ImportMap map_by_names() {
    ImportMap map;
    map.format = SourceFormat::detected;
    for (const RecordingColumn& target : recording_columns()) {
        ColumnMap column;
        column.column = target;
        column.source.name = target.name;
        column.unit = unit_names(target.quantity).front();
        if (target.quantity == Quantity::time) {
            map.time = column;
        } else {
            column.source.may_be_missing = true;
            map.columns.push_back(column);
        }
    }
    return map;
}

}  // namespace millforce::host
