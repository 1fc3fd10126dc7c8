// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/engagement/engagement_estimate.hpp"
#include "estimation/engagement/engagement_table.hpp"

#include <cstddef>

namespace millforce::estimation {

/// A depth of cut that is known from elsewhere, as one more measurement.
template <typename Scalar>
struct KnownDepth {
    Scalar depth_mm{0};  ///< 0: none
    Scalar relative_sd{0};
    bool K_s_is_in_doubt = true;  ///< a depth in true millimetres; false: one found from forces with the same K_s
};

/// The profile likelihood of the immersion for one set of measured forces: at each immersion the depth that fits best,
/// and how badly it fits. Every force is proportional to the depth, m_i = a_p g_i(R_r), so
///
///   a_p = Σ w m g / Σ w g²,   J(R_r) = Σ w (m − a_p g)²,   w = 1/σ²,   0 ≤ a_p ≤ a_p,max
///
/// σ² of a force along an axis also holds the misfit of the closed law and the uncertainty of r_1 and K_s; an immersion
/// from another method adds (R_r − R_other)²/σ², a known depth (a_p − a_known)²/σ². An axis at rest adds (m − a_p
/// g)²/σ² where its least force m exceeds a_p g; it does not act on a_p. a_p,max is the length of the flutes, larger by
/// two deviations of K_s: an immersion that asks for more explains nothing. Cost of a value: some hundred instructions
/// at a node of the table, twice as many between nodes. Bodies: immersion_profile_impl.hpp.
template <typename Scalar, int Nodes>
class ImmersionProfile {
  public:
    using Table = EngagementTable<Scalar, Nodes>;

    struct Value {
        Scalar misfit{0};  ///< J
        Scalar depth_mm{0};
        Scalar information{0};  ///< Σ w g²: inverse variance of the depth at this immersion
        Scalar ln_t_in_references{0};
    };

    ImmersionProfile() = default;
    /// `law`: any table of the law in question. `largest_depth_mm`: a_p,max; 0: not bounded.
    ImmersionProfile(const Table& law, const AverageForceMeasurement<Scalar>& forces, Scalar feed_per_tooth_mm,
                     Scalar law_relative_sd, const KnownDepth<Scalar>& known, Scalar largest_depth_mm);

    void set_known_depth(const KnownDepth<Scalar>& known) { known_ = known; }

    [[nodiscard]] Value at(const Table& table, Scalar theta_rad) const;
    [[nodiscard]] Value at_node(const Table& table, std::size_t node) const;

    /// The depth that F_at alone asks for at a node.
    [[nodiscard]] Scalar depth_by_tangential_mm(const Table& table, std::size_t node) const {
        return forces_.tangential_N.value / table.at_node(node, feed_).tangential_N;
    }

    [[nodiscard]] const typename Table::Feed& feed() const { return feed_; }
    [[nodiscard]] const typename Table::Doubt& doubt_of_K_s() const { return K_s_; }

  private:
    /// What one force adds to the sums. A weight of 0: it was not measured.
    struct Term {
        Scalar measured{0};  // m
        Scalar per_mm{0};    // g
        Scalar weight{0};    // w
    };

    [[nodiscard]] Value value_of(const typename Table::Forces& model, Scalar theta_rad) const;
    /// How well the law is known at an immersion, and what it is applied to.
    struct LawDoubt {
        Scalar depth_mm{0};    // that F_at alone asks for
        Scalar edge_share{0};  // of F_at
        Scalar K_s{0};         // variances of ln K_s and ln r_1
        Scalar r_1{0};
    };

    [[nodiscard]] LawDoubt law_doubt(const typename Table::Forces& model) const;
    [[nodiscard]] Term along_axis(const Measurement<Scalar>& force_N, const typename Table::Forces& model,
                                  const LawDoubt& doubt, Scalar direction_x, Scalar direction_y) const;
    [[nodiscard]] Term of_known_depth(const LawDoubt& doubt) const;
    [[nodiscard]] Scalar misfit_of_resting_axis(const typename Table::Forces& model, const LawDoubt& doubt,
                                                Scalar depth_mm) const;

    AverageForceMeasurement<Scalar> forces_{};  // variances along the axes with the law's misfit
    KnownDepth<Scalar> known_{};
    typename Table::Feed feed_{};
    typename Table::Doubt K_s_{};
    typename Table::Doubt r_1_{};
    Scalar tangential_weight_{0};
    Scalar largest_depth_mm_{0};  // 0: not bounded
};

}  // namespace millforce::estimation
