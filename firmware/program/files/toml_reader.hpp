// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace millforce::host {

/// Reads values out of a TOML file, with errors that a user can act on. Each table must be closed with
/// reject_unknown_keys(), which names the nearest known key. Errors are InputError: file, line, column, key, value,
/// what was expected.
class TomlFile {
  public:
    /// Parses the file. Throws InputError where it cannot be read or is not TOML.
    static TomlFile open(const std::string& path);
    /// The same from text; `name` appears in the messages.
    static TomlFile from_text(const std::string& text, const std::string& name);

    class Table {
      public:
        [[nodiscard]] bool exists() const { return table_ != nullptr; }
        [[nodiscard]] bool has(const std::string& key) const;
        /// For reject_unknown_keys(): the key is known, whether or not its value is asked for.
        void know(const std::string& key) { known_.push_back(key); }

        /// Number within [minimum, maximum]; `fallback` if the key is missing, an error if there is none. The unit
        /// stands in the messages alone.
        double number(const std::string& key, double minimum, double maximum, std::optional<double> fallback = {},
                      std::string_view unit = {});
        /// As number, and whole: 4 or 4.0.
        std::int64_t integer(const std::string& key, std::int64_t minimum, std::int64_t maximum,
                             std::optional<std::int64_t> fallback = {}, std::string_view unit = {});
        std::string text(const std::string& key, std::optional<std::string> fallback = {});
        /// An array of texts; empty where the key is missing.
        std::vector<std::string> texts(const std::string& key);
        bool boolean(const std::string& key, bool fallback);
        /// One of the choices, as its index. Booleans count as the words false and true.
        std::size_t choice(const std::string& key, const std::vector<std::string>& choices,
                           std::optional<std::size_t> fallback = {});
        /// An array of tables, e.g. [[profile]].
        std::vector<Table> tables(const std::string& key);
        Table table(const std::string& key);

        /// Every key that no call above asked for is an error that names the nearest known one.
        void reject_unknown_keys() const;
        [[noreturn]] void fail(const std::string& key, const std::string& what) const;

      private:
        friend class TomlFile;
        Table(const toml::table* table, std::string file, std::string name)
            : table_(table), file_(std::move(file)), name_(std::move(name)) {}
        std::optional<double> number_in_range(const std::string& key, double minimum, double maximum,
                                              const std::string& expected, bool has_fallback);
        const toml::node* find(const std::string& key);
        [[nodiscard]] std::string place(const toml::node* node) const;
        [[nodiscard]] std::string full(const std::string& key) const;

        const toml::table* table_;
        std::string file_;
        std::string name_;
        std::vector<std::string> known_;
    };

    Table root() { return Table(&root_, path_, ""); }
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    TomlFile(toml::table root, std::string path) : root_(std::move(root)), path_(std::move(path)) {}
    toml::table root_;
    std::string path_;
};

}  // namespace millforce::host
