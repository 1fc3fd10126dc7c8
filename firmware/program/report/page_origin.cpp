// SPDX-License-Identifier: Apache-2.0
#include "report/page_origin.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <sys/utsname.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "files/printable.hpp"

namespace millforce::host {

namespace {

/// As it was typed, but for the folder of the program; words with blanks in quotes.
std::string command_of_this_process() {
    std::ifstream in("/proc/self/cmdline", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::string command;
    for (std::size_t begin = 0; begin < bytes.size();) {
        const std::size_t end = std::min(bytes.find('\0', begin), bytes.size());
        std::string word = bytes.substr(begin, end - begin);
        if (begin == 0) {
            word = std::filesystem::path(word).filename().string();
        }
        const bool is_plain = !word.empty() && word.find_first_of(" '\"\\$") == std::string::npos;
        command += (begin == 0 ? "" : " ") + (is_plain ? word : "'" + word + "'");
        begin = end + 1;
    }
    return without_controls(command);
}

std::string system_of_this_computer() {
    utsname name{};
    return uname(&name) == 0 ? fmt::format("{} {}", name.sysname, name.release) : std::string();
}

}  // namespace

Facts facts_of_this_process() {
    return {{"Program", fmt::format("millforce {}, {}", MILLFORCE_VERSION, system_of_this_computer())},
            {"Command", command_of_this_process()}};
}

std::string date_and_time() {
    return fmt::format("{:%Y-%m-%d %H:%M:%S %z}", fmt::localtime(std::time(nullptr)));
}

}  // namespace millforce::host
