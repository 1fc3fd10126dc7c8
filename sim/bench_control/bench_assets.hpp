// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// Files that the benchmark brings along, embedded at build time. The memory is static.

namespace millforce::sim::bench_assets {

std::string_view page_template();
std::string_view tuned_settings();
std::string_view vmc_machine();
std::string_view vfd_machine();

}  // namespace millforce::sim::bench_assets
