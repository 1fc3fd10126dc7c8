// SPDX-License-Identifier: Apache-2.0
#include "parameters/parameter_choices.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace millforce::host {

std::vector<std::string> words_of(const char* choices) {
    std::vector<std::string> words{""};
    for (const char* c = choices; *c != '\0'; ++c) {
        if (*c == '|') {
            words.emplace_back();
        } else {
            words.back() += *c;
        }
    }
    return words;
}

double decimal(float value) {
    return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

}  // namespace millforce::host
