// SPDX-License-Identifier: Apache-2.0
#include "commission/workpieces.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace millforce::host {

namespace {

constexpr auto table = std::to_array<Workpiece>({
    {"steel_low_carbon", "non-alloy steel below 0.25 % C, annealed (group 1)", 1350.0, -0.21},
    {"steel", "non-alloy steel of 0.25 % C and more, annealed, e.g. C45 (group 2)", 1500.0, -0.22},
    {"steel_alloy", "low-alloy steel, annealed (group 6)", 1775.0, -0.24},
    {"steel_alloy_hardened", "low-alloy steel, quenched and tempered to 350 HB (group 9)", 1800.0, -0.24},
    {"steel_tool", "high-alloy and tool steel, annealed (group 10)", 2450.0, -0.23},
    {"stainless", "austenitic stainless steel (group 14)", 2150.0, -0.20},
    {"cast_iron", "grey cast iron, ferritic or pearlitic (group 15)", 1150.0, -0.20},
    {"cast_iron_nodular", "nodular cast iron, ferritic (group 17)", 1225.0, -0.25},
    {"aluminium", "wrought aluminium, hardenable (group 22)", 800.0, -0.25},
    {"aluminium_cast", "cast aluminium up to 12 % Si (group 23)", 700.0, -0.25},
    {"brass", "brass (group 27)", 700.0, -0.27},
    {"nickel", "nickel-based alloy, annealed (group 33)", 3300.0, -0.24},
    {"titanium", "titanium, alpha and beta alloys, hardened (group 37)", 1245.0, -0.24},
});

}  // namespace

std::span<const Workpiece> workpieces() {
    return table;
}

std::vector<std::string> workpiece_names() {
    std::vector<std::string> names;
    names.reserve(table.size());
    for (const Workpiece& workpiece : table) {
        names.emplace_back(workpiece.name);
    }
    return names;
}

const Workpiece& workpiece_of(const std::string& name) {
    const auto found = std::find_if(table.begin(), table.end(), [&](const Workpiece& w) { return name == w.name; });
    if (found == table.end()) {
        throw std::logic_error("no workpiece " + name);
    }
    return *found;
}

}  // namespace millforce::host
