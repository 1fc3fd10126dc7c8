// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/peak_factors.hpp"
#include "estimation/engagement/engagement_solver.hpp"

#include <cmath>

namespace millforce::estimation {

/// Tooth peaks per F_at at the engagement that is known, and at those that may come.
///
/// They depend on the engagement alone, which comes once per solution; the forces come with every tooth period. So
/// take() and its two other parts read all tables once, and what is left for a tooth period are products. Cost of the
/// three: up to seven readings of the peak table (peak_factors.hpp), three of the forces' table; what the present
/// engagement does not ask for is not read. Memory: both sides' peak tables, 2.9 KiB in float. Not thread-safe.
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
        PeakFactorSettings<Scalar> peak{};  ///< with the side that is told
        Scalar largest_depth_mm{10};        ///< taken until a depth is known
        Scalar assumed_immersion{1};        ///< taken until an immersion is known
        Scalar surge_immersion{0};
        Scalar turn_immersion{0};
    };

    /// Peak of one tooth per F_at.
    struct Factors {
        Scalar now{1};
        Scalar slot{1};    ///< the widest cut at the same depth
        Scalar at_low{1};  ///< at the ends of the immersion's interval
        Scalar at_high{1};
        Scalar by_K_s{0};     ///< change of `now` by one deviation of K_s
        Scalar bound{1};      ///< what the narrowest cut and the smallest depth that the forces allow load one tooth
        Scalar narrowest{1};  ///< the same where no force tells anything
        Scalar surge{1};      ///< where it is wider than now
        Scalar turn{1};
    };

    EngagementPeaks() = default;
    [[gnu::cold]] EngagementPeaks(const CuttingLaw<Scalar>& law, const Settings& settings)
        : largest_depth_mm_(settings.largest_depth_mm),
          surge_(place_of(settings.surge_immersion)),
          turn_(place_of(settings.turn_immersion)),
          slot_(place_of(Scalar(2))),
          now_(place_of(settings.assumed_immersion)) {
        down_.build(law, with_side(settings.peak, CutSide::down));
        up_.build(law, with_side(settings.peak, CutSide::up));
    }

    /// A solution of the engagement. Where it has no immersion the last one stays. take_changes() and take_bounds()
    /// belong to it.
    void take(const EngagementEstimate<Scalar>& found, const EngagementSolver<Scalar>& solver) {
        if (found.immersion_valid) {
            now_ = {found.engagement_rad, found.radial_immersion};
            side_ = found.side;
            last_depth_mm_ = found.depth_valid ? found.axial_depth_mm : last_depth_mm_;
        }
        // However doubtful: it is the depth that goes with the immersion.
        const bool has_depth = found.immersion_valid && found.axial_depth_mm > Scalar(0);
        const Scalar usual_mm = last_depth_mm_ > Scalar(0) ? last_depth_mm_ : largest_depth_mm_;
        depth_mm_ = has_depth ? found.axial_depth_mm : usual_mm;
        here_node_ = solver.table(side_).between(now_.theta_rad);
        factors_.now = factor(side_, now_, depth_mm_);
        factors_.slot = factor(side_, slot_, depth_mm_);
    }

    /// The second part of take(): the engagements that may come.
    void take_changes(const EngagementSolver<Scalar>& solver) {
        const Table& table = solver.table(side_);
        if (surge_is_wider()) {
            surge_node_ = table.between(surge_.theta_rad);
            factors_.surge = factor(side_, surge_, depth_mm_);
        }
        if (turn_is_wider()) {
            turn_node_ = table.between(turn_.theta_rad);
            factors_.turn = factor(side_, turn_, depth_mm_);
        }
    }

    /// The third part of take(), with the same solution and the feed that it was asked for.
    void take_bounds(const EngagementEstimate<Scalar>& found, const EngagementSolver<Scalar>& solver,
                     const typename Table::Feed& feed) {
        read_bounds(found, found.immersion_valid && found.axial_depth_mm > Scalar(0));
        factors_.by_K_s = change_by_K_s(solver.table(side_), feed);
    }

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
    [[nodiscard]] static Place place_of(Scalar radial_immersion) {
        using elementary::acos;
        return {acos(Scalar(1) - clamp(radial_immersion, Scalar(0), Scalar(2))), radial_immersion};
    }
    [[nodiscard]] static PeakFactorSettings<Scalar> with_side(PeakFactorSettings<Scalar> settings, CutSide unknown_is) {
        settings.side = settings.side == CutSide::unknown ? unknown_is : settings.side;
        return settings;
    }

    [[nodiscard]] Scalar factor(CutSide side, const Place& cut, Scalar depth_mm) const {
        const ToothPeakTable<Scalar>& table = side == CutSide::up ? up_ : down_;
        return table.at_angle(cut.theta_rad, cut.radial_immersion, depth_mm);
    }

    void read_bounds(const EngagementEstimate<Scalar>& e, bool has_depth) {
        const Place low{e.engagement_low_rad, e.radial_immersion_low};
        if (e.immersion_valid) {
            const Place high{e.engagement_high_rad, e.radial_immersion_high};
            factors_.at_low = factor(side_, low, has_depth ? e.depth_at_low_mm : depth_mm_);
            factors_.at_high = factor(side_, high, has_depth ? e.depth_at_high_mm : depth_mm_);
        } else if (e.solved) {
            factors_.bound = factor(side_, low, e.depth_at_high_mm);
        } else {
            factors_.narrowest = factor(side_, Place{}, Scalar(0));
        }
    }

    /// An error in K_s is an error of the depth, and so of how much of the edge is taken to be in cut.
    [[nodiscard]] Scalar change_by_K_s(const Table& table, const typename Table::Feed& feed) const {
        using std::sqrt;
        if (!(feed.G_N_per_mm > Scalar(0))) {
            return Scalar(0);
        }
        const Scalar variance = table.doubt_of_K_s().variance_at(Table::ln_t_in_references(here_node_, feed));
        const Scalar shallower_mm = depth_mm_ * (Scalar(1) - sqrt(variance));
        return factor(side_, now_, shallower_mm) - factors_.now;
    }

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
    typename Table::Node here_node_{};
    typename Table::Node surge_node_{};
    typename Table::Node turn_node_{};
};

}  // namespace millforce::estimation
