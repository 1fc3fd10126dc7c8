// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// The page's own parts, embedded at build time. The memory is static.

namespace millforce::host::map_page_assets {

std::string_view map_template();
std::string_view map_script();

}  // namespace millforce::host::map_page_assets
