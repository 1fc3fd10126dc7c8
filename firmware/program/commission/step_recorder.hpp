// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "commission/samples.hpp"
#include "commission/session.hpp"
#include "recording/recording.hpp"

namespace millforce::host {

/// Samples of a running machine, for a watch and into the session's recordings. Files are written by a thread beside
/// the caller, so that a slow disk does not hold up the bus.
class StepRecorder {
  public:
    /// `in_pieces`: a file every ten seconds, between moves; what was recorded before a crash counts then. Else one at
    /// the end. All outlive this.
    StepRecorder(const Session& session, std::string step, std::uint32_t counts_per_rev, StepWatch& watch,
                 bool in_pieces);

    /// Returns whether the step is over: there has been enough, and the axes have rested, for a second.
    bool add(const hal::DriveSample& sample);
    /// There is enough. May be called by another thread.
    [[nodiscard]] bool is_enough() const { return is_enough_.load(std::memory_order_relaxed); }
    /// Writes what is left, and waits for it. Throws InputError where a file could not be written.
    void finish();

  private:
    void look(double time_s);
    void note_rest(double time_s, const hal::DriveSample& sample);
    void write_piece();
    static void write_file(const std::filesystem::path& file, std::uint32_t counts_per_rev,
                           const std::vector<RecordedStep>& steps);

    const Session& session_;
    std::string step_;
    std::uint32_t counts_per_rev_;
    StepWatch& watch_;
    bool in_pieces_;
    std::vector<RecordedStep> steps_;
    std::optional<hal::DriveSample> first_{};
    std::uint64_t time_us_ = 0;
    std::uint32_t last_time_us_ = 0;
    double piece_start_s_ = 0.0;
    std::optional<double> rests_since_s_{};
    std::optional<double> enough_since_s_{};
    bool has_moved_ = false;
    std::uint32_t samples_ = 0;
    std::atomic<bool> is_enough_{false};
    std::future<void> writing_{};
};

/// Feeds the recordings of a step to its watch, as if the machine ran.
void feed_recordings(const std::vector<std::filesystem::path>& files, std::uint32_t counts_per_rev, StepWatch& watch);

}  // namespace millforce::host
