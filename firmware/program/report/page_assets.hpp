// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// What every page is made of, embedded at build time by PageAssets.cmake. The memory is static.

namespace millforce::host::page_assets {

std::string_view report_style();
std::string_view charts_script();
std::string_view dygraphs_script();
std::string_view dygraphs_style();

}  // namespace millforce::host::page_assets
