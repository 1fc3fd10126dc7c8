// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string_view>
#include <variant>

#include "parameters/local_io.hpp"
#include "parameters/parameter_choices.hpp"
#include "parameters/parameter_files.hpp"
#include "parameters/parameter_table.hpp"

namespace millforce::host {

namespace {

std::string joined_words(const char* choices) {
    std::string list;
    for (const std::string& word : words_of(choices)) {
        list += (list.empty() ? "" : ", ") + word;
    }
    return list;
}

const char* name_of(ParameterType type) {
    switch (type) {
        case ParameterType::number:
            return "number";
        case ParameterType::integer:
            return "integer";
        case ParameterType::flag:
            return "flag";
        case ParameterType::enumeration:
            return "enumeration";
    }
    return "";
}

/// What a key holds, of whatever table its row is.
struct KeyValue {
    ParameterType type;
    bool is_required;
    double default_value;
    double minimum;
    double maximum;
    const char* choices;
};

std::string default_of(const KeyValue& row) {
    if (row.is_required) {
        return "required";
    }
    switch (row.type) {
        case ParameterType::flag:
            return row.default_value > 0.5 ? "true" : "false";
        case ParameterType::enumeration:
            return words_of(row.choices)[static_cast<std::size_t>(row.default_value)];
        case ParameterType::integer:
            return fmt::format("{:.0f}", row.default_value);
        case ParameterType::number:
            break;
    }
    return fmt::format("{:g}", row.default_value);
}

std::string range_of(const KeyValue& row) {
    switch (row.type) {
        case ParameterType::flag:
            return "false, true";
        case ParameterType::enumeration:
            return joined_words(row.choices);
        case ParameterType::integer:
            return fmt::format("{:.0f} … {:.0f}", row.minimum, row.maximum);
        case ParameterType::number:
            break;
    }
    return fmt::format("{:g} … {:g}", row.minimum, row.maximum);
}

std::string key_row(const char* key, const char* unit, const char* sentence, const KeyValue& value) {
    return fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", key, name_of(value.type), unit, default_of(value),
                       range_of(value), sentence);
}

constexpr const char* key_columns = "| key | type | unit | default | range | meaning |\n|---|---|---|---|---|---|\n";

std::string heading_of(const std::string& table) {
    if (table == "axis") {
        return "[x], [y], [z]";
    }
    return table == "bus.drive" ? "[bus.spindle], [bus.x], [bus.y], [bus.z]" : "[" + table + "]";
}

/// Writes the heading of a table where another one begins.
class Headings {
  public:
    explicit Headings(std::string& text) : text_(text) {}

    void enter(const char* table) {
        if (table_ == table) {
            return;
        }
        table_ = table;
        text_ += fmt::format("\n### {}\n\n{}", heading_of(table_), key_columns);
    }

  private:
    std::string& text_;
    std::string table_;
};

void document_file(firmware::ParameterFile file, std::string& text) {
    Headings headings(text);
    for (const ParameterRow& row : parameter_table()) {
        if (row.file == file) {
            headings.enter(row.table);
            text += key_row(row.key, row.unit, row.sentence,
                            {row.type, row.is_required, static_cast<double>(row.default_value),
                             static_cast<double>(row.minimum), static_cast<double>(row.maximum), row.choices});
        }
    }
}

void document_objects(std::string& text) {
    text +=
        "\n### Objects of [bus.spindle], [bus.x], [bus.y], [bus.z]\n\n| key | form | default | meaning "
        "|\n|---|---|---|---|\n";
    for (const auto& row : text_table()) {
        text += fmt::format("| `{}` | `{}` | {} | {} |\n", row.key, row.form, row.default_text, row.sentence);
    }
}

std::string heading_of_local(const std::string& table) {
    return table == "iio.drive" ? "[iio.spindle], [iio.x], [iio.y], [iio.z]" : "[" + table + "]";
}

/// With the default as the structure has it.
KeyValue value_of(const LocalValueRow& row) {
    LocalIoKeys defaults;
    return std::visit(
        [&row]<typename Field>(const Field* field) {
            return KeyValue{type_of<Field>(), row.is_required, static_cast<double>(*field),
                            row.minimum,      row.maximum,     row.choices};
        },
        row.field(defaults, 0));
}

void document_local_io(std::string& text) {
    text += "\n### Inputs and outputs of this computer, for `millforce run` on Linux\n";
    for (const char* table : {"iio", "iio.drive", "override_voltage", "feed_hold_line"}) {
        text += fmt::format("\n### {}\n\n{}", heading_of_local(table), key_columns);
        for (const LocalTextRow& row : local_texts) {
            if (std::string_view(row.table) == table) {
                text += fmt::format("| `{}` | text |  | none | `{}` | {} |\n", row.key, row.form, row.sentence);
            }
        }
        for (const LocalValueRow& row : local_values) {
            if (std::string_view(row.table) == table) {
                text += key_row(row.key, row.unit, row.sentence, value_of(row));
            }
        }
    }
}

void document_information(std::string& text) {
    text +=
        "\n## Keys for information\n\nA calibration writes them for the reader of its file; the controller does not "
        "use them. Each key with a\nnumber, here or above, may have a companion `KEY_se`: the standard error of its "
        "fit.\n\n"
        "| table | key | unit | meaning |\n|---|---|---|---|\n";
    for (const auto& row : information_table()) {
        const std::string_view table = row.table;
        const std::string range = row.choices != nullptr ? fmt::format(" ({})", joined_words(row.choices)) : "";
        text += fmt::format("| {} | `{}` | {} | {}{} |\n", heading_of(std::string(table)), row.key, row.unit,
                            row.sentence, range);
    }
}

}  // namespace

std::string parameter_documentation() {
    std::string text =
        "# Parameters\n\nMade by `millforce parameters`. Free text keys `name` and `description` may stand at the top "
        "of either file.\n\n## machine.toml\n";
    document_file(firmware::ParameterFile::machine, text);
    document_objects(text);
    document_local_io(text);
    text += "\n## tool.toml\n";
    document_file(firmware::ParameterFile::tool, text);
    document_information(text);
    return text;
}

}  // namespace millforce::host
