// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "commands/command_line.hpp"
#include "daemon/line_printer.hpp"
#include "parameters/tool_set.hpp"
#include "part_map/part_map_file.hpp"
#include "part_map/way_along_map.hpp"

namespace millforce::host {

/// What a live controller does with part maps.
struct MapOptions {
    std::string program;
    std::string map;
    std::string learn;
};

/// --program, --map and --learn.
void add_map(Command& command, MapOptions& options);

/// The part maps of a live controller, for one tool: one that is looked ahead in, and one that is learnt. One thread.
class LiveMaps {
  public:
    /// Reads the map, and refuses one of another program or tool, and --learn where nothing can be written. Throws
    /// InputError. Says on standard error which map it is.
    LiveMaps(const MapOptions& options, const ToolChoice& tool, const firmware::Parameters<float>& parameters);

    /// A machine connects: nothing has agreed with the map yet. Null where there is nothing to do.
    [[nodiscard]] firmware::WaySource<float>* begin();
    /// The map does not fit the cut, and is not looked ahead in.
    [[nodiscard]] bool is_refuted() const { return follower_ != nullptr && follower_->is_refuted(); }
    /// Since the last call the map was dropped, because it does not fit the cut.
    [[nodiscard]] bool was_dropped();
    /// Writes what was learnt, if anything was. False, with a line on standard error, where that failed.
    [[nodiscard]] bool finish();

  private:
    MapOptions options_;
    firmware::Parameters<float> parameters_;
    MapOrigin origin_{};
    std::optional<PartMap> map_;
    std::unique_ptr<MapLearner> learner_;
    std::unique_ptr<MapFollower> follower_;
    std::optional<WayAlongMap> way_;
    bool is_dropped_ = false;
};

}  // namespace millforce::host
