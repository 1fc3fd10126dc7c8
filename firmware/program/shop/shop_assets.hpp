// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// The files of the shop's page, embedded at build time. The memory is static.

namespace millforce::host::shop_assets {

std::string_view shop_page();
std::string_view shop_style();
std::string_view shop_script();

}  // namespace millforce::host::shop_assets
