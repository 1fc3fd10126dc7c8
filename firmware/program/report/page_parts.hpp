// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

/// Pieces of HTML that the pages have in common, and figures as they write them.

namespace millforce::host {

/// The document up to its body; `title` is HTML. Of a page that is one file, with its styles in it.
std::string page_head(std::string_view title, std::initializer_list<std::string_view> styles);
/// Of a page that a server gives with its other files: the names of its styles.
std::string served_page_head(std::string_view title, std::initializer_list<std::string_view> style_files);

/// Times that are compared are written alike: in minutes where the longest of them is. NaN: a dash.
std::string readable_time(double time_s, double longest_s);
std::string readable_time(double time_s);
/// A share in whole percent, "under 1 %" where it would look like nothing.
std::string readable_share(double share);

/// Name and value of the list of facts; nothing for an empty value. `value` is text and is escaped.
std::string fact_html(std::string_view name, std::string_view value);

/// A figure in large type with what it means below. `style`: "", "hero", "held", "over".
std::string stat_html(std::string_view style, std::string_view value, std::string_view meaning);

}  // namespace millforce::host
