// SPDX-License-Identifier: Apache-2.0
#include "report/page_template.hpp"

#include "report/utf8.hpp"

namespace millforce::host {

std::string filled(std::string_view text, std::initializer_list<PageFilling> fillings) {
    std::string out;
    while (true) {
        const std::size_t open = text.find("{{");
        const std::size_t close = text.find("}}", open);
        out += text.substr(0, open);
        if (open == std::string_view::npos || close == std::string_view::npos) {
            return out;
        }
        const std::string_view name = text.substr(open + 2, close - open - 2);
        for (const auto& [key, filling] : fillings) {
            if (key == name) {
                out += filling;
            }
        }
        text.remove_prefix(close + 2);
    }
}

std::string_view without_source_map(std::string_view text) {
    const std::size_t mark = text.rfind("# sourceMappingURL=");
    return mark == std::string_view::npos ? text : text.substr(0, mark - 2);
}

std::string html_escaped(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        const std::string_view sequence = text.substr(0, length);
        if (length == 0) {
            out += "\uFFFD";
        } else if (sequence == "&") {
            out += "&amp;";
        } else if (sequence == "<") {
            out += "&lt;";
        } else if (sequence == ">") {
            out += "&gt;";
        } else if (sequence == "\"") {
            out += "&quot;";
        } else if (sequence == "'") {
            out += "&#39;";
        } else {
            out += sequence;
        }
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return out;
}

}  // namespace millforce::host
