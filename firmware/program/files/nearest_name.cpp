// SPDX-License-Identifier: Apache-2.0
#include "files/nearest_name.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace millforce::host {

namespace {

// Levenshtein's distance, one row at a time.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t k = 1; k <= b.size(); ++k) {
            const std::size_t replaced = diagonal + (a[i - 1] == b[k - 1] ? 0U : 1U);
            diagonal = row[k];
            row[k] = std::min({row[k] + 1, row[k - 1] + 1, replaced});
        }
    }
    return row[b.size()];
}

/// "top" for "top_mm": the unit was forgotten.
bool is_without_unit(std::string_view name, std::string_view candidate) {
    return !name.empty() && candidate.size() > name.size() && candidate.starts_with(name) &&
           candidate[name.size()] == '_';
}

}  // namespace

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
    const auto whole = std::find_if(candidates.begin(), candidates.end(),
                                    [&](const std::string& candidate) { return is_without_unit(name, candidate); });
    if (whole != candidates.end()) {
        return *whole;
    }
    std::string best;
    std::size_t least = name.size() / 2 + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t longer = std::max(name.size(), candidate.size());
        const std::size_t shorter = std::min(name.size(), candidate.size());
        if (longer - shorter >= least) {
            continue;  // as many letters differ at least; and a name of megabytes costs nothing
        }
        const std::size_t distance = edit_distance(name, candidate);
        if (distance < least) {
            least = distance;
            best = candidate;
        }
    }
    return best;
}

}  // namespace millforce::host
