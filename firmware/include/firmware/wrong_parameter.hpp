// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/file_tables.hpp"

#include <optional>

/// Which value makes parameters wrong. A tick with such parameters holds the feed with the fault bad_configuration, or
/// has no estimate; this says why, for a program that sets parameters itself. Files and flash blocks are checked where
/// they are read. Compares each of some 300 values with its range: for a start, not for each sample. No heap.

namespace millforce::firmware {

struct WrongParameter {
    ParameterName name;  ///< file and key; its table: table_in_file(name)
    float value;         ///< may be NaN
    float minimum;       ///< of the range; an override_max must be above it
    float maximum;
};

namespace detail {

class WrongParameterSearch {
  public:
    template <typename Field>
    void operator()(const ParameterName& name, const Field& field, float minimum, float maximum) {
        const auto value = static_cast<float>(field);
        const bool is_in_range = value >= minimum && value <= maximum;  // not so NaN
        if (!is_in_range && !first_) {
            first_ = WrongParameter{name, value, minimum, maximum};
        }
    }
    [[nodiscard]] const std::optional<WrongParameter>& first() const { return first_; }

  private:
    std::optional<WrongParameter> first_;
};

}  // namespace detail

/// The first value that is out of its range or no number, or a largest override that is not above the smallest. Without
/// one no tick has the fault bad_configuration.
template <typename Scalar>
std::optional<WrongParameter> first_wrong_parameter(const Parameters<Scalar>& parameters) {
    detail::WrongParameterSearch search;
    for_each_machine_parameter(parameters.machine, search);
    for_each_tool_parameter(parameters.tool, search);
    const CncParameters<Scalar>& cnc = parameters.machine.cnc;
    if (search.first() || cnc.override_max > cnc.override_min) {
        return search.first();
    }
    return WrongParameter{ParameterName{ParameterFile::machine, "cnc", "override_max"},
                          static_cast<float>(cnc.override_max), static_cast<float>(cnc.override_min), 9.0F};
}

}  // namespace millforce::firmware
