// SPDX-License-Identifier: Apache-2.0
#include "files/printable.hpp"

namespace millforce::host {

std::string without_controls(std::string_view text) {
    constexpr unsigned char first_byte_of_controls = 0xC2;  // of two, in UTF-8
    std::string result;
    unsigned char last = 0;
    for (const char letter : text) {
        const auto code = static_cast<unsigned char>(letter);
        if (last == first_byte_of_controls && code >= 0x80 && code < 0xA0) {
            result.back() = '?';
        } else {
            result += code < 0x20 || code == 0x7F ? '?' : letter;
        }
        last = code;
    }
    return result;
}

std::string printable(std::string_view text) {
    constexpr std::size_t most = 60;
    const std::string shown = without_controls(text.substr(0, most));
    return text.size() > most ? shown + "…" : shown;
}

std::string name_list(const std::vector<std::string>& names) {
    constexpr std::size_t most = 12;
    std::string result;
    for (std::size_t k = 0; k < names.size() && k < most; ++k) {
        result += (k > 0 ? ", " : "") + printable(names[k]);
    }
    return names.size() > most ? result + ", …" : result;
}

}  // namespace millforce::host
