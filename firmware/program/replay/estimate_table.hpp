// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>

#include "estimation/surface/roughness.hpp"
#include "files/atomic_file.hpp"
#include "files/progress.hpp"
#include "firmware/tick_record.hpp"
#include "parameters/tool_set.hpp"
#include "replay/estimate_rows.hpp"
#include "replay/wide_band_cells.hpp"
#include "run_log/tool_forces.hpp"

namespace millforce::host {

/// Which samples get a row: the first, and then one after each interval, to the microsecond. Sums of seconds are not
/// that exact: at 50 Hz and 0.02 s every third sample came too early by their last digit.
class RowTimes {
  public:
    explicit RowTimes(double interval_s);

    bool is_due(double time_s);
    [[nodiscard]] std::size_t rows() const { return rows_; }
    /// Samples without a row, where the samples come so slowly that one would expect a row for each. Else empty.
    [[nodiscard]] std::string left_out() const;

  private:
    std::int64_t interval_us_;
    std::int64_t first_us_ = 0;
    std::int64_t last_us_ = 0;
    std::int64_t next_us_ = 0;
    std::size_t samples_ = 0;
    std::size_t rows_ = 0;
};

/// Where the forces of the wide-band methods come from.
enum class WideBandSource : std::uint8_t { none, drives, force_sensor };

/// The table of a replay, whatever it reads: header, rows, notes, and a line of progress while it grows. Nothing is
/// written before commit(): an error in the last row must not leave half a table behind.
class EstimateTable {
  public:
    struct Settings {
        std::string log;        ///< named in the notes
        std::string output;     ///< file; empty: standard output
        double interval_s;      ///< between two rows; 0: a row for each sample
        bool may_print = true;  ///< false: standard output is taken, and without a file the rows are dropped
    };
    /// One tick, as the table shows it.
    struct Row {
        double time_s;
        const firmware::TickRecord& record;
        std::uint32_t tool;
        const estimation::RoughnessPrediction<float>& roughness;
        const WideBandCells::Estimates& wide_band;
    };

    /// What a tool's own tables add is shown for one tool alone: another may have other tables, or none.
    EstimateTable(const Settings& settings, const ToolSet& tools, WideBandSource wide_band);

    /// Once for each sample.
    bool is_due(double time_s) { return times_.is_due(time_s); }
    void write(const Row& row);
    void show_progress(double share) { progress_.update(share); }

    [[nodiscard]] bool is_empty() const { return times_.rows() == 0; }
    [[nodiscard]] bool goes_to_a_file() const { return file_.has_value(); }
    /// What the user should know of the rows, on standard error.
    void show_notes() const;
    /// Writes the table. To a file: also a summary on standard output, its first line with `about_the_log`.
    void commit(std::string_view about_the_log, const WideBandCells::Estimates& made);

  private:
    [[nodiscard]] std::ostream& out() { return file_ ? file_->stream() : held_back_; }

    Settings settings_;
    ToolForces forces_;
    ToolCells numbers_;
    RoughnessCells roughness_;
    WideBandCells wide_band_;
    RowTimes times_;
    std::optional<AtomicFile> file_;
    std::ostringstream held_back_;
    Progress progress_;
};

}  // namespace millforce::host
