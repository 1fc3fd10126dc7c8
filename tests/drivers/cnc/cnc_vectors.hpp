// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "hal/can_frame.hpp"

/// Reads drivers/cnc/vectors.txt: each line as words, without comments and empty lines.

namespace millforce::test {

using Words = std::vector<std::string>;

inline std::vector<Words> cnc_vectors() {
    std::ifstream file(MILLFORCE_SOURCE_DIR "/drivers/cnc/vectors.txt");
    std::vector<Words> lines;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line.substr(0, line.find('#')));
        Words read;
        for (std::string word; words >> word;) {
            read.push_back(word);
        }
        if (!read.empty()) {
            lines.push_back(read);
        }
    }
    return lines;
}

inline std::uint32_t decimal(const std::string& word) {
    return static_cast<std::uint32_t>(std::stoul(word));
}

/// Of the id at place `id` and all words from `bytes` on.
inline hal::CanFrame frame_of(const Words& words, std::size_t id, std::size_t bytes) {
    hal::CanFrame frame;
    frame.id = static_cast<std::uint32_t>(std::stoul(words.at(id), nullptr, 16));
    for (std::size_t k = bytes; k < words.size(); ++k) {
        frame.data.at(frame.length++) = static_cast<std::uint8_t>(std::stoul(words[k], nullptr, 16));
    }
    return frame;
}

}  // namespace millforce::test
