// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

#include "files/input_error.hpp"
#include "iio/scan_layout.hpp"

namespace millforce::host {

/// Throws InputError where it does not fit.
inline iio::Path local_path(const std::string& key, const std::string& text) {
    const iio::Path path(text);
    if (path.view().empty()) {
        throw InputError(
            fmt::format("{} = \"{}\": expected a path of 1 to {} characters", key, text, iio::path_capacity - 1));
    }
    return path;
}

inline iio::ChannelName local_channel(const std::string& key, const std::string& text) {
    iio::ChannelName name{};
    if (!iio::set(name, text)) {
        throw InputError(fmt::format("{} = \"{}\": expected the name of a channel, e.g. \"voltage0\"", key, text));
    }
    return name;
}

}  // namespace millforce::host
