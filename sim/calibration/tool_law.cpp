#include "calibration/calibration_keys.hpp"
#include "calibration/estimate.hpp"
#include "files/input_error.hpp"
#include "files/nearest_name.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <vector>

namespace millforce::sim {

namespace {

std::string place(const std::filesystem::path& file, const toml::source_region& source) {
    return fmt::format("{}:{}:{}", file.string(), source.begin.line, source.begin.column);
}

std::vector<std::string> known_keys() {
    std::vector<std::string> keys;
    for (const CalibrationKey& key : cutting_coefficient_keys) {
        keys.emplace_back(key.name);
        keys.push_back(std::string(key.name) + "_se");
    }
    for (const CalibrationKey& key : cutting_doubt_keys) {
        keys.emplace_back(key.name);
    }
    keys.emplace_back(cut_side_key);
    return keys;
}

/// Numbers of one table.
class NumberReader {
  public:
    NumberReader(const std::filesystem::path& file, const toml::table& table) : file_(file), table_(table) {}

    double optional(std::string_view key, double low, double high, double otherwise) const {
        const toml::node* node = table_.get(key);
        if (node == nullptr) {
            return otherwise;
        }
        const auto value = node->value<double>();
        if (!node->is_number() || !value || !(*value >= low && *value <= high)) {
            throw InputError(
                fmt::format("{}: key 'cutting.{}': {}; expected a number from {} to {}", place(file_, node->source()),
                            key, value && node->is_number() ? fmt::format("{}", *value) : "not a number", low, high));
        }
        return *value;
    }

    double required(std::string_view key, double low, double high) const {
        if (table_.get(key) == nullptr) {
            throw InputError(fmt::format("{}: no key 'cutting.{}'; expected a number from {} to {}",
                                         place(file_, table_.source()), key, low, high));
        }
        return optional(key, low, high, 0.0);
    }

  private:
    const std::filesystem::path& file_;
    const toml::table& table_;
};

void refuse_unknown_keys(const std::filesystem::path& file, const toml::table& table) {
    const std::vector<std::string> known = known_keys();
    for (const auto& [key, node] : table) {
        const std::string name(key.str());
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            const std::string nearest = nearest_name(name, known);
            throw InputError(fmt::format(
                "{}: key 'cutting.{}' is not known; {}", place(file, node.source()), name,
                nearest.empty() ? "expected the keys of a cutting law" : fmt::format("the nearest is '{}'", nearest)));
        }
    }
}

estimation::CutSide read_side(const std::filesystem::path& file, const toml::table& table) {
    const toml::node* node = table.get(cut_side_key);
    if (node == nullptr) {
        return estimation::CutSide::down;
    }
    const auto text = node->value<std::string>();
    if (text && *text == "up") {
        return estimation::CutSide::up;
    }
    if (text && *text == "down") {
        return estimation::CutSide::down;
    }
    throw InputError(fmt::format("{}: key 'cutting.{}': {}; expected \"down\" or \"up\"", place(file, node->source()),
                                 cut_side_key, text ? "'" + *text + "'" : "not a text"));
}

}  // namespace

ToolLaw read_tool_law(const std::filesystem::path& file) {
    toml::table document;
    try {
        document = toml::parse_file(file.string());
    } catch (const toml::parse_error& error) {
        throw InputError(fmt::format("{}: {}", place(file, error.source()), error.description()));
    }
    const toml::table* table = document["cutting"].as_table();
    if (table == nullptr) {
        throw InputError(
            fmt::format("{}: no table [cutting]; expected the output of 'millforce calibrate cutting'", file.string()));
    }
    refuse_unknown_keys(file, *table);
    const NumberReader numbers(file, *table);
    ToolLaw tool;
    auto& law = tool.law;
    law.k_s_N_per_mm2 = numbers.required("k_s_N_per_mm2", 1e-3, 1e6);
    law.p_s = numbers.required("p_s", -0.99, 1.0);
    law.k_1 = numbers.required("k_1", -100.0, 100.0);
    law.p_1 = numbers.required("p_1", -2.0, 2.0);
    law.K_te_N_per_mm = numbers.optional("K_te_N_per_mm", -1e4, 1e4, 0.0);
    law.K_re_N_per_mm = numbers.optional("K_re_N_per_mm", -1e4, 1e4, 0.0);
    law.K_s_relative_sd = numbers.optional("K_s_relative_sd", 0.0, 10.0, 0.0);
    law.K_s_exponent_sd = numbers.optional("K_s_exponent_sd", 0.0, 10.0, 0.0);
    law.r_1_relative_sd = numbers.optional("r_1_relative_sd", 0.0, 10.0, 0.0);
    law.r_1_exponent_sd = numbers.optional("r_1_exponent_sd", 0.0, 10.0, 0.0);
    law.reference_chip_thickness_mm = numbers.optional("reference_chip_thickness_mm", 0.0, 100.0, 0.0);
    law.minimum_chip_thickness_mm = numbers.optional("minimum_chip_thickness_mm", 0.0, 100.0, 0.0);
    law.maximum_chip_thickness_mm = numbers.optional("maximum_chip_thickness_mm", 0.0, 100.0, 0.0);
    tool.side = read_side(file, *table);
    return tool;
}

}  // namespace millforce::sim
