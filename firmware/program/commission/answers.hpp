// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files/toml_reader.hpp"

namespace millforce::host {

/// A question for a number. The key is that of the file where there is one ("tool.diameter_mm"), so that an answer can
/// be looked up with `millforce parameters`.
struct NumberQuestion {
    std::string key;
    std::string words;
    std::string unit;
    double minimum = 0.0;
    double maximum = 0.0;
    std::optional<double> usual = {};  ///< taken where there is no answer; without it the answer is needed. NaN: it
                                       ///< follows from another answer, which is missing
    bool is_whole = false;
};

struct WordQuestion {
    std::string key;
    std::string words;
    std::vector<std::string> choices;  ///< empty: any text
    std::optional<std::string> usual = {};
};

/// Answers from KEY=VALUE on the command line, from a file (TOML, the same keys), and from a terminal, in this order;
/// at last the usual value. Where no terminal asks, missing answers are collected for require_all(). Keys that no
/// question asked for are an error.
class Answers {
  public:
    /// `file` may be empty. Throws InputError.
    Answers(const std::string& file, const std::vector<std::string>& pairs);

    /// Answers that come last, and that nobody need ask for: of an earlier run, or what the drives say.
    void add_known(const std::string& file);

    /// From now on what has no answer is asked for here. Both outlive this.
    void ask_on(std::istream& in, std::ostream& out);

    [[nodiscard]] bool asks() const { return in_ != nullptr; }

    /// NaN where the answer is missing. Throws InputError where it is out of range.
    double number(const NumberQuestion& question);
    std::int64_t integer(const NumberQuestion& question);
    std::string word(const WordQuestion& question);
    [[nodiscard]] bool has(const std::string& key);

    /// Throws InputError that names every missing answer, and with `is_last` each answer that nobody asked for.
    void require_all(bool is_last = true) const;

    /// What was asked and taken so far, as KEY = VALUE lines that an answer file may hold.
    [[nodiscard]] std::string text() const;

  private:
    void miss(const std::string& answer);
    void reject_unknown_keys() const;
    struct Source {
        TomlFile file;
        bool is_strict = true;  ///< a key that nobody asks for is an error
        std::map<std::string, TomlFile::Table> tables{};
        TomlFile::Table& table(const std::string& name);
    };
    [[nodiscard]] Source* source_of(const std::string& key);
    void take(const std::string& key, const std::string& value);
    std::optional<std::string> line_from_terminal(const std::string& prompt);
    std::optional<double> number_from_terminal(const NumberQuestion& question);

    std::vector<std::unique_ptr<Source>> sources_;
    std::istream* in_ = nullptr;
    std::ostream* out_ = nullptr;
    std::vector<std::string> missing_;
    std::vector<std::pair<std::string, std::string>> taken_;
};

}  // namespace millforce::host
