// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "reproduce/reproduction.hpp"

namespace millforce::sim {

/// reproduce.html: one self-contained page with a section per paper: what its system does, the figures, the plots, the
/// checks of our own, where this project differs from print, and what it does not reproduce. Everything but the plots'
/// drawing is plain HTML and needs no script. The page asks the network for nothing, and its content security policy
/// forbids it to.
[[nodiscard]] std::string reproduction_page(std::span<const Reproduction> reproductions);

}  // namespace millforce::sim
