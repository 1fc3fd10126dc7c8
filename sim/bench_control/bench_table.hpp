// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench_control/contenders.hpp"

namespace millforce::sim {

/// The value that this share of them does not exceed, by linear interpolation; NaN where there is none. 0 ≤ share ≤ 1.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// One contender over all of its runs. Times are over the bound of the same part and the same plant; a run that did not
/// finish counts as infinitely long. NaN: no run, or no bound for any.
struct ContenderFigures {
    const Contender* contender;
    std::vector<double> times_over_bound;
    std::vector<double> peaks;
    int runs = 0;
    int unfinished = 0;
    int teeth_broken = 0;
    int runs_with_a_broken_tooth = 0;
    double revolutions_over_mean = 0.0;
    double rubbing_share = 0.0;  ///< of the time in cut

    [[nodiscard]] double time(double share) const { return quantile(times_over_bound, share); }
    [[nodiscard]] double peak(double share) const { return quantile(peaks, share); }
};

/// In the order of contenders(), those that have runs.
[[nodiscard]] std::vector<ContenderFigures> figures_of_runs(const std::vector<BenchRun>& runs);

/// Median time over the bound of one contender on one part; NaN where there is none.
struct PartFigures {
    std::string part;
    std::vector<double> times_over_bound;  ///< in the order of the contenders asked for
    std::vector<double> peaks_95;
};
[[nodiscard]] std::vector<PartFigures> figures_of_parts(const std::vector<BenchRun>& runs,
                                                        const std::vector<ContenderFigures>& contenders);

/// A table's cells: a head and rows.
struct BenchTable {
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
};
[[nodiscard]] BenchTable table_of(const std::vector<ContenderFigures>& figures);
[[nodiscard]] BenchTable table_of_parts(const std::vector<PartFigures>& parts,
                                        const std::vector<ContenderFigures>& contenders);
[[nodiscard]] std::string markdown(const BenchTable& table);

}  // namespace millforce::sim
