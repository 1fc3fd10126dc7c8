// SPDX-License-Identifier: Apache-2.0
#include "check/finding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

namespace millforce::host {

namespace {

constexpr std::array<std::string_view, 3> severity_names{"note", "warning", "error"};

std::string_view name_of(Severity severity) {
    return severity_names[static_cast<std::size_t>(severity)];
}

std::ptrdiff_t number_of(const Findings& findings, Severity severity) {
    return std::count_if(findings.begin(), findings.end(),
                         [severity](const Finding& finding) { return finding.severity == severity; });
}

std::string with_plural(std::ptrdiff_t count, std::string_view name) {
    return fmt::format("{} {}{}", count, name, count == 1 ? "" : "s");
}

}  // namespace

std::string line_of(const Finding& finding) {
    return fmt::format("{}: {} [{}]", name_of(finding.severity), finding.words, finding.key);
}

std::string count_of(const Findings& findings) {
    const std::ptrdiff_t errors = number_of(findings, Severity::error);
    const std::ptrdiff_t warnings = number_of(findings, Severity::warning);
    const std::string notes = with_plural(number_of(findings, Severity::note), name_of(Severity::note));
    return errors + warnings == 0
               ? fmt::format("nothing found; {}", notes)
               : fmt::format("{} found: {}, {}; {}", errors + warnings, with_plural(errors, name_of(Severity::error)),
                             with_plural(warnings, name_of(Severity::warning)), notes);
}

bool is_something_wrong(const Findings& findings) {
    return number_of(findings, Severity::note) < static_cast<std::ptrdiff_t>(findings.size());
}

void append(Findings& findings, Findings more) {
    std::move(more.begin(), more.end(), std::back_inserter(findings));
}

}  // namespace millforce::host
