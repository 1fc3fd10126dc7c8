// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

/// Self-contained pages out of a template and its fillings.

namespace millforce::host {

using PageFilling = std::pair<std::string_view, std::string_view>;

/// Replaces {{name}} by the filling of that name in one pass, so that a filling may contain anything.
std::string filled(std::string_view text, std::initializer_list<PageFilling> fillings);

/// A library's file without its pointer to a source map: nothing here is loaded from elsewhere.
std::string_view without_source_map(std::string_view text);

/// Text as HTML: & < > " ' as entities, bytes that are not UTF-8 as U+FFFD.
std::string html_escaped(std::string_view text);

}  // namespace millforce::host
