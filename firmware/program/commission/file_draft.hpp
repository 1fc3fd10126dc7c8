// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "firmware/parameter_fields.hpp"

namespace millforce::host {

/// A machine.toml or tool.toml that is being put together: the keys that have a value, each with where it comes from.
/// Written in the order of the parameter table, each key below a comment with its meaning and unit.
class FileDraft {
  public:
    explicit FileDraft(firmware::ParameterFile file) : file_(file) {}

    /// Free text at the top of the file: `name`, `description`.
    void set_heading(const std::string& key, const std::string& value);
    /// `table` as it stands in the file ("x", "bus.spindle"). A key that is set again keeps the last value. `source`
    /// goes behind the value as a comment; empty: none.
    void set(const std::string& table, const std::string& key, double value, const std::string& source = {});
    void set_integer(const std::string& table, const std::string& key, std::int64_t value,
                     const std::string& source = {});
    void set_flag(const std::string& table, const std::string& key, bool value, const std::string& source = {});
    void set_text(const std::string& table, const std::string& key, const std::string& value,
                  const std::string& source = {});
    void set_texts(const std::string& table, const std::string& key, const std::vector<std::string>& values,
                   const std::string& source = {});
    /// All tables and keys of a file that a calibration wrote, standard errors too. Throws InputError.
    void merge(const std::filesystem::path& fitted, const std::string& source);

    [[nodiscard]] bool has(const std::string& table, const std::string& key) const;
    void write(std::ostream& out) const;
    /// Writes `path`, whole or not at all.
    void save(const std::filesystem::path& path) const;

  private:
    struct Value {
        std::string text;  ///< as it stands in the file
        std::string source;
    };
    using Table = std::map<std::string, Value>;

    void put(const std::string& table, const std::string& key, std::string text, const std::string& source);
    void write_key(std::ostream& out, const std::string& table, const char* key, const char* unit,
                   const char* sentence) const;
    [[nodiscard]] std::vector<std::string> table_names() const;

    firmware::ParameterFile file_;
    std::vector<std::pair<std::string, std::string>> headings_;
    std::map<std::string, Table> tables_;
};

}  // namespace millforce::host
