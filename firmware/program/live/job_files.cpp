// SPDX-License-Identifier: Apache-2.0
#include "live/job_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <utility>

#include "files/atomic_file.hpp"
#include "files/console.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

JobFiles::JobFiles(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder_, error) || ::access(folder_.c_str(), W_OK | X_OK) != 0) {
        throw InputError(fmt::format("--jobs: {}: expected a folder that can be written", folder_.string()));
    }
}

void JobFiles::on_turn() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    write(jobs_.look(static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(now).count())));
}

void JobFiles::write(const std::optional<JobReport>& report) {
    if (!report) {
        return;
    }
    const std::filesystem::path file = folder_ / (job_id(*report) + ".json");
    try {
        AtomicFile writing(file);
        writing.stream() << job_json(*report) << '\n';
        writing.commit();
    } catch (const InputError& error) {
        failed_ = file.string();
        print_line(stderr, fmt::format("millforce: {}", error.what()));
    }
}

}  // namespace millforce::host
