// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <span>
#include <string>
#include <string_view>

#include "firmware/wide_band_monitor.hpp"
#include "firmware/wide_band_settings.hpp"

namespace millforce::host {

/// A column of the wide-band methods; NaN: no estimate.
struct WideBandColumn {
    const char* name;
    float (*value)(const firmware::WideBandEstimate<float>& made, const firmware::ToolParameters<float>& tool);
};
[[nodiscard]] std::span<const WideBandColumn> wide_band_columns();
[[nodiscard]] inline bool has_wide_band(bool has_sensor, const firmware::ToolParameters<float>& tool) {
    return has_sensor || firmware::has_force_drop_law(tool);
}

/// The columns of the wide-band methods, where the recording has a force sensor or the tool's parameters ask for force
/// drops from the drives. Missing parameters are reported once, on standard error; the cells are then empty.
class WideBandCells {
  public:
    using Estimates = firmware::WideBandEstimate<float>;

    WideBandCells(bool has_sensor, const firmware::ToolParameters<float>& tool)
        : tool_(tool), has_sensor_(has_sensor), is_there_(has_wide_band(has_sensor, tool_)) {}

    void show_what_is_missing() const;
    void write_header(std::ostream& out) const;
    void write(std::ostream& out, const Estimates& made) const;
    [[nodiscard]] std::string summary(const Estimates& made) const;

  private:
    [[nodiscard]] std::string_view lacking_for_force_drops() const;
    [[nodiscard]] std::string_view lacking_for_depths() const;

    firmware::ToolParameters<float> tool_;
    bool has_sensor_;
    bool is_there_;
};

}  // namespace millforce::host
