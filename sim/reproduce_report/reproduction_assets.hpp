// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// The files that reproduce.html is made of in addition to every page's, embedded at build time. The memory is static.

namespace millforce::sim::reproduction_assets {

std::string_view page_template();
std::string_view page_style();
std::string_view page_script();

}  // namespace millforce::sim::reproduction_assets
