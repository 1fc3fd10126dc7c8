// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands/command_line.hpp"
#include "parameters/tool_set.hpp"
#include "part_map/part_map_file.hpp"
#include "part_map/way_along_map.hpp"

namespace millforce::host {

/// What a live controller does with part maps.
struct MapOptions {
    std::string program;
    std::vector<std::string> maps;                                       ///< one, or with tools by number one for each
    std::string learn;                                                   ///< a file; with tools by number a folder
    double stock_tolerance_mm = MapLearner::default_stock_tolerance_mm;  ///< of what is learnt

    [[nodiscard]] bool is_any() const { return !maps.empty() || !learn.empty(); }
};

/// --stock-tolerance, beside the command's --learn.
void add_stock_tolerance(Command& command, const Option& learn, double& tolerance_mm);

/// --program, --map, --learn and --stock-tolerance.
void add_map(Command& command, MapOptions& options);

/// The part maps of a live controller: those that are looked ahead in, and those that are learnt, of the one tool or of
/// each tool by its number. One thread.
class LiveMaps {
  public:
    /// Reads the maps, and refuses one of another program or tool, two for one tool, and --learn where nothing can be
    /// written. Throws InputError. Says on standard error which maps they are.
    LiveMaps(const MapOptions& options, const ToolChoice& choice, const ToolSet& tools);

    /// A machine connects: nothing has agreed with the maps yet. Null where there is nothing to do.
    [[nodiscard]] firmware::WaySource<float>* begin();
    /// The map of the tool in the spindle does not fit the cut, and is not looked ahead in.
    [[nodiscard]] bool is_refuted() const { return way_ && way_->is_refuted(); }
    /// Those that were dropped since the last call because they do not fit the cut: "part map", "part map of T7".
    [[nodiscard]] std::vector<std::string> dropped();
    /// Writes what was learnt, if anything was. False, with a line on standard error, where that failed.
    [[nodiscard]] bool finish();

  private:
    /// Of a tool by its number; 0: the one tool.
    struct Followed {
        PartMap map;
        std::unique_ptr<MapFollower> follower{};
        bool is_dropped = false;
    };

    /// Says which map it is.
    std::string read(const std::string& file, const ToolChoice& choice);
    void prepare_to_learn(const ToolChoice& choice);
    [[nodiscard]] std::filesystem::path file_to_learn(std::uint32_t number) const;
    [[nodiscard]] bool write(std::uint32_t number, const PartMap& map) const;

    MapOptions options_;
    bool has_numbers_;
    firmware::MachineParameters<float> machine_;
    std::vector<firmware::NumberedTool> tools_;  // without numbers the one tool as 0
    std::map<std::uint32_t, MapOrigin> origins_{};
    std::map<std::uint32_t, Followed> maps_{};
    std::unique_ptr<MapLearner> learner_{};
    std::optional<WayAlongMap> way_{};
};

}  // namespace millforce::host
