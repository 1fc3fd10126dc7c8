// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace millforce::host {

/// The folder of a commissioning: answers, what the drives say, recordings, fits. Every file appears whole or not at
/// all, and what is done follows from the files that are there: a run that was interrupted, or killed, goes on.
class Session {
  public:
    /// Makes the folder. Throws InputError where it cannot.
    explicit Session(const std::filesystem::path& folder);

    [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] bool has(const std::string& name) const { return std::filesystem::exists(file(name)); }
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

    /// Recordings of a step in their order: "air.1.csv", "air.2.csv" …
    [[nodiscard]] std::vector<std::filesystem::path> recordings(const std::string& step) const;
    [[nodiscard]] std::filesystem::path next_recording(const std::string& step) const;
    /// Recordings that a fit refused, or the operator: renamed, so that the step is done again.
    void set_aside(const std::string& step) const;

    void write(const std::string& name, const std::string& text) const;

  private:
    std::filesystem::path folder_;
};

}  // namespace millforce::host
