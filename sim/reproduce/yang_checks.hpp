// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "reproduce/reproduction.hpp"
#include "reproduce/yang_published.hpp"
#include "reproduce/yang_random_cuts.hpp"

/// Checks of our own about Yang, DeVor & Kapoor: formulas of the paper against simulated forces, the profile fit, and a
/// thousand cuts drawn at random.

namespace millforce::sim::yang {

/// Mean absolute error of a method over some tests, in percent of nominal, and how many of the estimates there are.
struct MeanError {
    double sum_percent = 0.0;
    int count = 0;
    int missing = 0;

    void add(const Series& series, Method method);
    [[nodiscard]] double percent() const { return sum_percent / count; }
    [[nodiscard]] double answered_share() const { return static_cast<double>(count) / (count + missing); }
    [[nodiscard]] std::string missing_text() const;  ///< " (16 of 20 estimated)", "" where none is missing

  private:
    void add(double error_percent);
};
[[nodiscard]] MeanError mean_error(const std::vector<Series>& all, Method method,
                                   std::initializer_list<std::size_t> types);

/// Filter and vector sum shift a corner of the force by the slopes on its sides.
inline constexpr double corner_bound_deg = 1.5;

/// "Table 5 (type I)"
[[nodiscard]] std::string table_name(std::size_t type);

/// The profile fit: how many depths it estimates, what it does with the tip's angle unknown, and with a harder piece.
void check_profile_fit(const std::vector<Series>& all, Reproduction& r);

/// PT_doc of a simulated force against Table 1, where the two agree and where they cannot.
void check_angles(const std::vector<Series>& all, Reproduction& r);

/// Eqs. 4 and 10–12, and the categories of the twelve cuts that are drawn.
void check_equations(Reproduction& r);

[[nodiscard]] std::vector<RandomCutOutcome> check_random_cuts(Reproduction& r);

}  // namespace millforce::sim::yang
