// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// The files that report.html is made of in addition to every page's, embedded at build time. The memory is static.

namespace millforce::sim::report_assets {

std::string_view report_template();
std::string_view top_view_script();
std::string_view report_script();

}  // namespace millforce::sim::report_assets
