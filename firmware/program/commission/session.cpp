// SPDX-License-Identifier: Apache-2.0
#include "commission/session.hpp"

#include <fmt/format.h>

#include <system_error>

#include "files/atomic_file.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

Session::Session(const std::filesystem::path& folder) : folder_(folder) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (!std::filesystem::is_directory(folder_)) {
        throw InputError(fmt::format("{}: {}; expected a folder for the session", folder_.string(),
                                     error ? error.message() : "not a folder"));
    }
}

std::vector<std::filesystem::path> Session::recordings(const std::string& step) const {
    std::vector<std::filesystem::path> files;
    for (int number = 1; has(fmt::format("{}.{}.csv", step, number)); ++number) {
        files.push_back(file(fmt::format("{}.{}.csv", step, number)));
    }
    return files;
}

std::filesystem::path Session::next_recording(const std::string& step) const {
    return file(fmt::format("{}.{}.csv", step, recordings(step).size() + 1));
}

void Session::set_aside(const std::string& step) const {
    std::filesystem::remove(file(step + "_cuts.csv"));  // first: without it the step is not done
    const auto files = recordings(step);
    for (auto file = files.rbegin(); file != files.rend(); ++file) {  // the last first: none is left without its begin
        std::filesystem::rename(*file, file->string() + ".refused");
    }
}

void Session::write(const std::string& name, const std::string& text) const {
    AtomicFile out(file(name));
    out.stream() << text;
    out.commit();
}

}  // namespace millforce::host
