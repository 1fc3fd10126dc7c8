// SPDX-License-Identifier: Apache-2.0
#include "import/table_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "files/input_error.hpp"
#include "files/nearest_name.hpp"
#include "files/printable.hpp"

namespace millforce::host {

namespace {

constexpr std::size_t most_lines_before_names = 100'000;
constexpr std::size_t most_lines_after_names = 20;
constexpr std::array separators{'\t', ';', ','};

/// "# time" is the name "time": numpy writes it so.
std::string without_comment_sign(const std::string& cell) {
    return std::string(without_spaces(cell.starts_with('#') ? std::string_view(cell).substr(1) : cell));
}

bool ends_path(const std::string& path, const std::string& end) {
    return path == end || path.ends_with("." + end);
}

const char* separator_shown(char separator) {
    return separator == '\t' ? "tab" : separator == ';' ? "';'" : "','";
}

}  // namespace

TableSource::TableSource(const std::string& file, const std::vector<SourceName>& sources, TableNames names)
    : SourceReader(sources.size()),
      lines_(file),
      sources_(sources),
      naming_(names),
      columns_(sources.size(), no_column) {
    find_first_line();
}

bool TableSource::is_comment() const {
    const std::string_view text = without_spaces(lines_.text());
    return text.starts_with('#') || text.starts_with('%') || text.starts_with("//");
}

void TableSource::find_first_line() {
    const bool by_name =
        std::any_of(sources_.begin(), sources_.end(), [](const SourceName& source) { return source.number == 0; });
    while (lines_.number() < most_lines_before_names && lines_.next()) {
        for (const char separator : separators) {
            if (!split_cells(lines_.text(), separator, cells_)) {
                continue;
            }
            if (by_name ? takes_as_names(cells_) : !is_comment() && takes_as_row(cells_)) {
                separator_ = separator;
                has_names_ = by_name;
                row_is_waiting_ = !by_name;
                first_line_ = lines_.number();
                return;
            }
        }
    }
    fail_without_names();
}

std::vector<std::size_t> TableSource::columns_named(const std::vector<std::string>& cells,
                                                    const SourceName& source) const {
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        if (naming_ == TableNames::end_of_path ? ends_path(cells[k], source.name) : cells[k] == source.name) {
            found.push_back(k);
        }
    }
    return found;
}

bool TableSource::takes_as_names(const std::vector<std::string>& cells) {
    std::vector<std::string> names = cells;
    names.front() = without_comment_sign(names.front());
    while (names.size() > 1 && names.back().empty()) {
        names.pop_back();
    }
    std::size_t found = 0;
    bool has_all = true;
    const SourceName* doubled = nullptr;
    for (std::size_t k = 0; k < sources_.size(); ++k) {
        const SourceName& source = sources_[k];
        const std::vector<std::size_t> places =
            source.number > 0 ? std::vector<std::size_t>{source.number - 1} : columns_named(names, source);
        const bool is_there = !places.empty() && places.front() < names.size();
        columns_[k] = is_there ? places.front() : no_column;
        found += is_there && source.number == 0 ? 1U : 0U;
        has_all = has_all && (is_there || source.may_be_missing);
        doubled = places.size() > 1 ? &source : doubled;
    }
    if (!has_all) {
        remember_nearest(names, found);
        return false;
    }
    if (doubled != nullptr) {
        lines_.fail(fmt::format("column '{}' is there more than once; expected once, or source_number",
                                printable(doubled->name)));
    }
    column_names_ = names;
    width_ = names.size();
    return true;
}

bool TableSource::takes_as_row(const std::vector<std::string>& cells) {
    for (std::size_t k = 0; k < sources_.size(); ++k) {
        columns_[k] = sources_[k].number - 1;
        NumberReader numbers;
        const bool is_number = columns_[k] < cells.size() && !cells[columns_[k]].empty() &&
                               numbers.read(cells[columns_[k]]).problem.empty();
        if (!is_number) {
            remember_nearest(cells, k);
            return false;
        }
    }
    width_ = cells.size();
    return true;
}

void TableSource::remember_nearest(const std::vector<std::string>& cells, std::size_t found) {
    const bool is_nearer = found > nearest_.found || (found == nearest_.found && cells.size() > nearest_.cells.size());
    if (is_nearer) {
        nearest_ = {cells, lines_.number(), found};
    }
}

void TableSource::fail_without_names() const {
    if (nearest_.cells.empty()) {
        throw InputError(fmt::format("{}: the file is empty; expected a table", lines_.file()));
    }
    for (const SourceName& source : sources_) {
        if (source.number > 0) {
            if (source.number <= nearest_.cells.size() && !nearest_.cells[source.number - 1].empty()) {
                continue;
            }
            throw InputError(fmt::format("{}:{}: no column {}; expected a line with at least that many cells",
                                         lines_.file(), nearest_.line, source.number));
        }
        if (!source.may_be_missing && columns_named(nearest_.cells, source).empty()) {
            const std::string nearest = nearest_name(source.name, nearest_.cells);
            throw InputError(fmt::format(
                "{}:{}: no column '{}'; {}the line has: {}", lines_.file(), nearest_.line, printable(source.name),
                nearest.empty() ? "" : fmt::format("the nearest is '{}'; ", printable(nearest)),
                name_list(nearest_.cells)));
        }
    }
    throw InputError(fmt::format("{}: no line with numbers in the columns asked for", lines_.file()));
}

bool TableSource::split_row() {
    if (!split_cells(lines_.text(), separator_, cells_)) {
        return false;
    }
    while (cells_.size() > width_ && cells_.back().empty()) {
        cells_.pop_back();
    }
    return cells_.size() == width_;
}

std::string TableSource::column_shown(std::size_t k) const {
    return sources_[k].number > 0 ? fmt::format("column {}", sources_[k].number)
                                  : fmt::format("column '{}'", printable(sources_[k].name));
}

/// False for a line that is no row of numbers, before the first one.
bool TableSource::read_row() {
    const bool may_be_no_row = !has_row_ && lines_.number() <= first_line_ + most_lines_after_names;
    if (!split_row()) {
        if (may_be_no_row) {
            return false;
        }
        lines_.fail(
            fmt::format("{} cells separated by {}; expected {}, as in line {}{}", cells_.size(),
                        separator_shown(separator_), width_, first_line_,
                        separator_ == ',' && cells_.size() > width_ ? " (decimal commas need another separator)" : ""));
    }
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (columns_[k] == no_column) {
            continue;
        }
        const CellNumber number = numbers_.read(cells_[columns_[k]]);
        if (!number.problem.empty()) {
            if (may_be_no_row) {
                return false;
            }
            lines_.fail(fmt::format("{}: '{}', {}", column_shown(k), printable(cells_[columns_[k]]), number.problem));
        }
        values_[k] = number.value;
    }
    return true;
}

bool TableSource::next() {
    while (row_is_waiting_ || lines_.next()) {
        row_is_waiting_ = false;
        if (without_spaces(lines_.text()).empty()) {
            continue;
        }
        if (is_comment()) {
            ++comments_;
            continue;
        }
        if (lines_.has_no_end() && has_row_ && !split_row() && cells_.size() < width_) {
            ++cut_off_;
            return false;
        }
        if (read_row()) {
            has_row_ = true;
            return true;
        }
        ++before_first_row_;
    }
    return false;
}

std::string TableSource::description() const {
    const char mark = numbers_.decimal_mark();
    return fmt::format(
        "table separated by {}{}, {}", separator_shown(separator_), mark == ',' ? ", decimal comma" : "",
        has_names_ ? fmt::format("names in line {}", first_line_) : fmt::format("rows from line {}", first_line_));
}

std::vector<std::string> TableSource::notes() const {
    std::vector<std::string> notes;
    add_note(notes, comments_, "comment line left out", "comment lines left out");
    add_note(notes, before_first_row_, "line between the names and the first row left out",
             "lines between the names and the first row left out");
    add_note(notes, cut_off_, "line left out: the last one, which is cut off", "lines left out");
    return notes;
}

}  // namespace millforce::host
