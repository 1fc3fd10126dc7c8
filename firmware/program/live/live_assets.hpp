// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// The web page's own files, embedded at build time. The memory is static.

namespace millforce::host::live_assets {

std::string_view live_template();
std::string_view live_style();
std::string_view elements_script();
std::string_view live_script();

}  // namespace millforce::host::live_assets
