// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "telemetry/job_watch.hpp"
#include "telemetry/telemetry_hub.hpp"

namespace millforce::host {

/// Writes a report of each job into a folder, `job-<µs since 1970>.json`. A file appears whole and is on the disk then;
/// who takes it elsewhere removes it.
class JobFiles final : public TelemetrySink {
  public:
    /// Throws InputError: no folder, or one that cannot be written.
    explicit JobFiles(std::filesystem::path folder);

    void on_sample(const Telemetry& telemetry) override { write(jobs_.follow(telemetry)); }
    void on_turn() override;
    void on_end() override { write(jobs_.end()); }
    [[nodiscard]] std::string failed_file() const override { return failed_; }

  private:
    void write(const std::optional<JobReport>& report);

    std::filesystem::path folder_;
    JobWatch jobs_{};
    std::string failed_{};
};

}  // namespace millforce::host
