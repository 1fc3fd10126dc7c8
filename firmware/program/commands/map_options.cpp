// SPDX-License-Identifier: Apache-2.0
#include "commands/map_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "files/console.hpp"
#include "files/input_error.hpp"
#include "files/overwriting.hpp"
#include "files/results_folder.hpp"
#include "part_map/numbered_maps.hpp"

namespace millforce::host {

namespace {

/// Without numbers the one tool as 0.
std::vector<firmware::NumberedTool> numbered(const ToolSet& tools) {
    return tools.tools().empty() ? std::vector<firmware::NumberedTool>{{0, tools.parameters().tool}} : tools.tools();
}

/// As a tool's file is called.
std::string name_of(std::uint32_t number, const ToolChoice& choice) {
    return number == 0 ? std::filesystem::path(choice.file).stem().string() : fmt::format("T{}", number);
}

}  // namespace

void add_stock_tolerance(Command& command, const Option& learn, double& tolerance_mm) {
    command
        .option("--stock-tolerance", tolerance_mm,
                "Of the map to write: by how much a blank may lie off in x and in y, in mm")
        .value_name("MM")
        .within(0.0, 10.0)
        .needs(learn)
        .shows_default();
}

void add_map(Command& command, MapOptions& options) {
    Option program = command.option("--program", options.program, "Part program that the maps belong to");
    program.value_name("PART.ngc");
    command
        .option("--map", options.maps,
                "Part map of 'millforce preview' or --learn, to look ahead with; with --tools again for each tool")
        .value_name("PART.map")
        .one_each_time()
        .needs(program);
    Option learn =
        command.option("--learn", options.learn,
                       "Write the part map of what this run estimated along its path; with --tools a folder of them");
    learn.value_name("PART.map").needs(program);
    add_stock_tolerance(command, learn, options.stock_tolerance_mm);
}

LiveMaps::LiveMaps(const MapOptions& options, const ToolChoice& choice, const ToolSet& tools)
    : options_(options),
      has_numbers_(choice.is_folder()),
      machine_(tools.parameters().machine),
      tools_(numbered(tools)) {
    if (!options.is_any()) {
        return;
    }
    for (const firmware::NumberedTool& tool : tools_) {
        origins_.emplace(tool.number, origin_of(options.program, name_of(tool.number, choice), tool.parameters));
    }
    if (!has_numbers_ && options.maps.size() > 1) {
        throw InputError(fmt::format("--map: {} maps for one tool, expected one, or --tools", options.maps.size()));
    }
    std::vector<std::string> read_files;
    read_files.reserve(options.maps.size());
    for (const std::string& file : options.maps) {
        read_files.push_back(read(file, choice));
    }
    if (!options.learn.empty()) {
        prepare_to_learn(choice);
    }
    for (const std::string& text : read_files) {
        print_line(stderr, text);
    }
}

std::string LiveMaps::read(const std::string& file, const ToolChoice& choice) {
    PartMapFile part = read_part_map(file);
    const std::uint32_t number = has_numbers_ ? number_of_map(file, part.origin, choice.folder, tools_) : 0;
    require_same_origin(file, part.origin, origins_.at(number));
    if (maps_.contains(number)) {
        throw InputError(fmt::format("{}: a second map for T{}, expected one for each tool", file, number));
    }
    std::string text = fmt::format("millforce: {}: looks ahead in {}, {:.0f} mm of path{}", file, part.origin.program,
                                   part.map.back().path_mm, has_numbers_ ? fmt::format(", with T{}", number) : "");
    maps_.emplace(number, Followed{std::move(part.map)});
    return text;
}

void LiveMaps::prepare_to_learn(const ToolChoice& choice) {
    learner_ = std::make_unique<MapLearner>(machine_, tools_);
    learner_->set_stock_tolerance(options_.stock_tolerance_mm);
    if (has_numbers_) {
        results_folder(options_.learn, file_to_learn(tools_.front().number).filename().string());
    } else {
        refuse_overwriting(options_.learn, {options_.program, choice.file});
        const std::filesystem::path folder = std::filesystem::absolute(options_.learn).parent_path();
        if (!std::filesystem::is_directory(folder)) {
            throw InputError(fmt::format("--learn: {}: no such folder", folder.string()));
        }
    }
    for (const firmware::NumberedTool& tool : tools_) {
        refuse_overwriting(file_to_learn(tool.number), {options_.program});
    }
}

std::filesystem::path LiveMaps::file_to_learn(std::uint32_t number) const {
    return has_numbers_ ? std::filesystem::path(options_.learn) / fmt::format("T{}.map", number)
                        : std::filesystem::path(options_.learn);
}

firmware::WaySource<float>* LiveMaps::begin() {
    if (!options_.is_any()) {
        return nullptr;
    }
    std::vector<WayAlongMap::Numbered> followers;
    for (auto& [number, followed] : maps_) {
        const auto tool = std::find_if(tools_.begin(), tools_.end(),
                                       [n = number](const firmware::NumberedTool& other) { return other.number == n; });
        const firmware::Parameters<float> parameters{machine_, tool->parameters};
        followed.follower = std::make_unique<MapFollower>(parameters, followed.map);
        followed.is_dropped = false;
        followers.push_back({number, followed.follower.get()});
    }
    way_.emplace(std::move(followers), learner_.get());
    return &*way_;
}

std::vector<std::string> LiveMaps::dropped() {
    std::vector<std::string> names;
    for (auto& [number, followed] : maps_) {
        const bool is_dropped = followed.follower != nullptr && followed.follower->is_refuted();
        if (is_dropped && !followed.is_dropped) {
            names.push_back(number == 0 ? "part map" : fmt::format("part map of T{}", number));
        }
        followed.is_dropped = is_dropped;
    }
    return names;
}

bool LiveMaps::finish() {
    if (learner_ == nullptr) {
        return true;
    }
    bool is_any_learnt = false;
    bool is_written = true;
    for (const firmware::NumberedTool& tool : tools_) {
        const PartMap map = learner_->map(tool.number);
        is_any_learnt = is_any_learnt || !map.empty();
        is_written = (map.empty() || write(tool.number, map)) && is_written;
    }
    if (!is_any_learnt) {
        print_line(stderr, fmt::format("millforce: {}: not written: the CNC reported no line and distance to go",
                                       options_.learn));
    }
    return is_written;
}

bool LiveMaps::write(std::uint32_t number, const PartMap& map) const {
    const std::string file = file_to_learn(number).string();
    try {
        write_part_map(file, {origins_.at(number), map});
    } catch (const InputError& error) {
        print_line(stderr, fmt::format("millforce: {}", error.what()));
        return false;
    }
    print_line(stderr, fmt::format("millforce: {}: {}", file, about_memory(map)));
    return true;
}

}  // namespace millforce::host
