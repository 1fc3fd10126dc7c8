// SPDX-License-Identifier: Apache-2.0
#include "remote/parameters_json.hpp"

#include <limits>
#include <string_view>

#include "parameters/parameter_choices.hpp"
#include "parameters/parameter_table.hpp"

namespace millforce::sim {

namespace {

class ParameterWriter {
  public:
    ParameterWriter(JsonWriter& out, firmware::ParameterFile file) : out_(out), file_(file) {}

    template <typename Field>
    void operator()(const firmware::ParameterName& name, const Field& field, float, float) {
        const host::ParameterRow& row = host::row_of(name);
        if (name.file != file_ || std::string_view(row.table).starts_with("bus")) {
            return;
        }
        change_table(host::tables_in_file(row.table)[name.place]);
        out_.key(row.key);
        write(row, field);
    }
    void end() {
        if (!table_.empty()) {
            out_.end_object();
        }
    }

  private:
    void change_table(std::string_view table) {
        if (table == table_) {
            return;
        }
        end();
        table_ = table;
        out_.key(table).begin_object();
    }
    template <typename Field>
    void write(const host::ParameterRow& row, const Field& field) {
        if constexpr (std::is_same_v<Field, bool>) {
            out_.boolean(field);
        } else if constexpr (std::is_enum_v<Field>) {
            out_.text(host::words_of(row.choices)[static_cast<std::size_t>(field)]);
        } else if constexpr (std::is_integral_v<Field>) {
            out_.integer(static_cast<std::int64_t>(field));
        } else {
            out_.number(host::decimal(field), std::numeric_limits<float>::max_digits10);
        }
    }

    JsonWriter& out_;
    firmware::ParameterFile file_;
    std::string_view table_;
};

}  // namespace

void write_parameters(JsonWriter& out, const firmware::Parameters<float>& parameters, firmware::ParameterFile file) {
    out.begin_object();
    ParameterWriter writer(out, file);
    firmware::for_each_parameter(parameters, [&writer](const auto& name, const auto& field, float low, float high) {
        writer(name, field, low, high);
    });
    writer.end();
    out.end_object();
}

}  // namespace millforce::sim
