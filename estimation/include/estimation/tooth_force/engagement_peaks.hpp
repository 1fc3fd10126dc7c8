// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/peak_factors.hpp"
#include "estimation/engagement/engagement_solver.hpp"

namespace millforce::estimation {

/// Tooth peaks per F_at at the engagement that is known, and at those that may come.
///
/// They depend on the engagement alone. take() reads all tables once per solution; what is left for the forces are
/// products. Cost: up to seven readings of the peak table (peak_factors.hpp), three of the forces' table; what the
/// present engagement does not ask for is not read. Memory: both sides' peak tables, 2.9 KiB in float. Not thread-safe.
/// Bodies: engagement_peaks_impl.hpp.
template <typename Scalar>
class EngagementPeaks {
  public:
    using Table = typename EngagementSolver<Scalar>::Table;

    /// A cut's width, as immersion and as the angle that goes with it.
    struct Place {
        Scalar theta_rad{0};
        Scalar radial_immersion{0};
    };

    struct Settings {
        PeakFactorSettings<Scalar> peak{};  ///< with the side of the tool
        Scalar largest_depth_mm{0};         ///< taken until a depth is known
        Scalar assumed_immersion{0};        ///< taken until an immersion is known
        Scalar surge_immersion{0};
        Scalar turn_immersion{0};
    };

    /// Peak of one tooth per F_at.
    struct Factors {
        Scalar now{1};
        Scalar slot{1};    ///< the widest cut at the same depth
        Scalar at_low{1};  ///< at the ends of the immersion's interval
        Scalar at_high{1};
        Scalar by_K_s{0};  ///< change of `now` by one deviation of K_s
        Scalar bound{1};   ///< without an immersion: the most that F_at allows
        Scalar surge{1};   ///< where it is wider than now
        Scalar turn{1};
    };

    EngagementPeaks() = default;
    EngagementPeaks(const CuttingLaw<Scalar>& law, const Settings& settings);

    /// A solution of the engagement, and the force and the feed that it was solved for. Without an immersion the last
    /// one stays, and a search for factors().bound is due.
    void take(const EngagementEstimate<Scalar>& found, const EngagementSolver<Scalar>& solver, Scalar tangential_N,
              Scalar feed_per_tooth_mm);
    [[nodiscard]] bool search_due() const { return places_left_ > 0; }
    /// One more part of that search.
    void search(const EngagementSolver<Scalar>& solver);

    [[nodiscard]] const Factors& factors() const { return factors_; }
    [[nodiscard]] const Place& now() const { return now_; }
    [[nodiscard]] CutSide side() const { return side_; }
    [[nodiscard]] Scalar depth_mm() const { return depth_mm_; }
    [[nodiscard]] bool surge_is_wider() const { return surge_.radial_immersion > now_.radial_immersion; }
    [[nodiscard]] bool turn_is_wider() const { return turn_.radial_immersion > now_.radial_immersion; }
    [[nodiscard]] const typename Table::Node& here_node() const { return here_node_; }
    [[nodiscard]] const typename Table::Node& surge_node() const { return surge_node_; }
    [[nodiscard]] const typename Table::Node& turn_node() const { return turn_node_; }

  private:
    [[nodiscard]] static Place place_of(Scalar radial_immersion);
    [[nodiscard]] Scalar factor(const Place& cut, Scalar depth_mm) const;
    void take_place(const EngagementEstimate<Scalar>& found);
    void read_changes(const Table& table);
    void read_ends(const EngagementEstimate<Scalar>& found);
    void begin_search(const EngagementEstimate<Scalar>& found, const Table& table, Scalar tangential_N);
    [[nodiscard]] Scalar change_by_K_s(const Table& table) const;

    ToothPeakTable<Scalar> down_{};
    ToothPeakTable<Scalar> up_{};
    Scalar largest_depth_mm_{10};
    Place surge_{};
    Place turn_{};
    Place slot_{};
    Place now_{};
    CutSide side_ = CutSide::unknown;
    Scalar last_depth_mm_{0};
    Scalar depth_mm_{0};
    Factors factors_{};
    typename Table::Feed feed_{};
    Scalar tangential_N_{0};
    Scalar place_rad_{0};  // that the search looks at next
    Scalar step_rad_{0};
    int places_left_ = 0;
    typename Table::Node here_node_{};
    typename Table::Node surge_node_{};
    typename Table::Node turn_node_{};
};

}  // namespace millforce::estimation
