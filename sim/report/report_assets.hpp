// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// The files that report.html is made of, embedded at build time by ReportAssets.cmake. The memory is static.

namespace millforce::sim::report_assets {

std::string_view report_template();
std::string_view report_style();
std::string_view charts_script();
std::string_view top_view_script();
std::string_view report_script();
std::string_view dygraphs_script();
std::string_view dygraphs_style();

}  // namespace millforce::sim::report_assets
