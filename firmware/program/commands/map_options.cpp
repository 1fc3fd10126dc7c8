// SPDX-License-Identifier: Apache-2.0
#include "commands/map_options.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "files/console.hpp"
#include "files/input_error.hpp"
#include "files/overwriting.hpp"

namespace millforce::host {

void add_map(Command& command, MapOptions& options) {
    Option program = command.option("--program", options.program, "Part program that the map belongs to");
    program.value_name("PART.ngc");
    command.option("--map", options.map, "Part map of 'millforce preview' or --learn, to look ahead with")
        .value_name("PART.map")
        .needs(program);
    command
        .option("--learn", options.learn,
                "Write the part map that this run leaves behind: what was estimated along its path")
        .value_name("PART.map")
        .needs(program);
}

LiveMaps::LiveMaps(const MapOptions& options, const ToolChoice& tool, const firmware::Parameters<float>& parameters)
    : options_(options), parameters_(parameters) {
    if (options.map.empty() && options.learn.empty()) {
        return;
    }
    if (tool.is_folder()) {
        throw InputError("--map, --learn: with --tools, expected --tool: a part map is for one tool");
    }
    origin_ = origin_of(options.program, std::filesystem::path(tool.file).stem().string(), parameters.tool);
    if (!options.map.empty()) {
        PartMapFile file = read_part_map(options.map);
        require_same_origin(options.map, file.origin, origin_);
        print_line(stderr, fmt::format("millforce: {}: looks ahead in {}, {:.0f} mm of path", options.map,
                                       file.origin.program, file.map.back().path_mm));
        map_ = std::move(file.map);
    }
    if (!options.learn.empty()) {
        refuse_overwriting(options.learn, {options.program, tool.file});
        learner_ = std::make_unique<MapLearner>(parameters);
        const std::filesystem::path folder = std::filesystem::absolute(options.learn).parent_path();
        if (!std::filesystem::is_directory(folder)) {
            throw InputError(fmt::format("--learn: {}: no such folder", folder.string()));
        }
    }
}

firmware::WaySource<float>* LiveMaps::begin() {
    if (!map_ && learner_ == nullptr) {
        return nullptr;
    }
    follower_ = map_ ? std::make_unique<MapFollower>(parameters_, *map_) : nullptr;
    is_dropped_ = false;
    way_.emplace(follower_.get(), learner_.get());
    return &*way_;
}

bool LiveMaps::was_dropped() {
    const bool is_dropped = is_refuted();
    const bool is_news = is_dropped && !is_dropped_;
    is_dropped_ = is_dropped;
    return is_news;
}

bool LiveMaps::finish() {
    if (learner_ == nullptr) {
        return true;
    }
    const PartMap map = learner_->map();
    if (map.empty()) {
        print_line(stderr, fmt::format("millforce: {}: not written: the CNC reported no line and distance to go",
                                       options_.learn));
        return true;
    }
    try {
        write_part_map(options_.learn, {origin_, map});
    } catch (const InputError& error) {
        print_line(stderr, fmt::format("millforce: {}", error.what()));
        return false;
    }
    print_line(stderr, fmt::format("millforce: {}: {}", options_.learn, about_memory(map)));
    return true;
}

}  // namespace millforce::host
