// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// The files that the page of a run is made of in addition to every page's, embedded at build time. The memory is
/// static.

namespace millforce::host::run_page_assets {

std::string_view run_template();
std::string_view run_style();
std::string_view run_script();

}  // namespace millforce::host::run_page_assets
