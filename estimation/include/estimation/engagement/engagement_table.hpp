// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cutting_law.hpp"
#include "estimation/number/elementary.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"
#include "estimation/number/stored.hpp"

#include <array>
#include <cstddef>

namespace millforce::estimation {

/// Average forces per mm of axial depth over the engagement of one side, tabulated, for the solver.
///
/// The feed acts on the law (cutting_law.hpp) through two factors alone, G = k_s f_z^(1+p_s) N/2π and r = k_1 f_z^p_1:
///
///   F_at = G a_t + e_t,   F_ax = G (a_x + r b_x) + e_x,   F_ay = G (a_y + r b_y) + e_y
///
/// The eight others depend only on the engagement θ (R_r = 1 − cos θ) and are stored in the nodes, evenly spaced in θ
/// from first_rad (R_r 0.02) to the side's largest; between nodes a parabola through three of them (error below 0.1 %
/// from R_r 0.05 on, 0.2 % below). Memory: 9 · Nodes scalars. Cost: at_node() 20 operations, at() some 60, both without
/// a transcendental function; feed() two exponentials and a logarithm, once per solution.
template <typename Scalar, int Nodes>
class EngagementTable {
  public:
    static constexpr Scalar first_rad = literal<Scalar>(0.2L);

    /// The law at a feed.
    struct Feed {
        Scalar G_N_per_mm{0};
        Scalar r{0};
        Scalar ln_f_in_references{0};  ///< ln(f_z/t_ref); 0 if there is no t_ref
    };

    struct Forces {
        Scalar tangential_N{0};
        Scalar feed_N{0};
        Scalar normal_N{0};
        Scalar feed_per_ln_r_1_N{0};
        Scalar normal_per_ln_r_1_N{0};
        Scalar cutting_tangential_N{0};  ///< part of tangential_N that is not edge force
        Scalar edge_feed_N{0};           ///< part of feed_N that is edge force
        Scalar edge_normal_N{0};
        Scalar ln_t_in_references{0};  ///< ln(t_a/t_ref); 0 if there is no t_ref
    };

    /// What the table holds of one engagement, whatever the feed.
    enum Entry : std::size_t { a_t, a_x, b_x, a_y, b_y, e_t, e_x, e_y, ln_sine, entries };
    using Node = std::array<Scalar, entries>;

    EngagementTable() = default;

    void build(const CuttingLaw<Scalar>& law, Scalar teeth, CutSide side, Scalar centre_offset_in_radii,
               Scalar largest_rad) {
        using elementary::log;
        law_ = law;
        teeth_ = teeth;
        has_reference_ = law.reference_chip_thickness_mm > Scalar(0);
        ln_reference_ = has_reference_ ? log(law.reference_chip_thickness_mm) : Scalar(0);
        step_rad_ = (largest_rad - first_rad) / Scalar(Nodes - 1);
        for (int k = 0; k < Nodes; ++k) {
            const Node node = node_at(angle_rad(Scalar(k)), side, centre_offset_in_radii);
            for (std::size_t j = 0; j < node.size(); ++j) {
                nodes_[static_cast<std::size_t>(k)][j] = static_cast<Stored<Scalar>>(node[j]);
            }
        }
    }

    [[nodiscard]] Scalar step_rad() const { return step_rad_; }
    [[nodiscard]] Scalar last_rad() const { return angle_rad(Scalar(Nodes - 1)); }
    [[nodiscard]] Scalar angle_rad(Scalar node) const { return first_rad + step_rad_ * node; }

    /// At zero feed only the edge forces remain.
    [[nodiscard]] Feed feed(Scalar feed_per_tooth_mm) const {
        using elementary::exp;
        using elementary::log;
        if (!(feed_per_tooth_mm > Scalar(0))) {
            return {};
        }
        const Scalar ln_f = log(feed_per_tooth_mm);
        return {law_.k_s_N_per_mm2 * exp(law_.p_s * ln_f) * feed_per_tooth_mm * (teeth_ * turns_per_rad<Scalar>),
                law_.k_1 * exp(law_.p_1 * ln_f), has_reference_ ? ln_f - ln_reference_ : Scalar(0)};
    }

    /// Of a coefficient: its relative variance at t_ref and the deviation of its exponent, which counts with
    /// ln(t_a/t_ref).
    struct Doubt {
        Scalar relative_variance{0};
        Scalar exponent_sd{0};

        [[nodiscard]] Scalar variance_at(Scalar ln_t_in_references) const {
            return relative_variance + square(exponent_sd * ln_t_in_references);
        }
    };
    [[nodiscard]] Doubt doubt_of_K_s() const { return {square(law_.K_s_relative_sd), law_.K_s_exponent_sd}; }
    [[nodiscard]] Doubt doubt_of_r_1() const { return {square(law_.r_1_relative_sd), law_.r_1_exponent_sd}; }

    /// ln(t_a/t_ref) at a node without the forces.
    [[nodiscard]] static Scalar ln_t_in_references(const Node& node, const Feed& feed) {
        return feed.ln_f_in_references + node[ln_sine];
    }

    [[nodiscard]] Forces at_node(std::size_t k, const Feed& feed) const { return forces(nodes_[k], feed); }

    /// θ outside of the table is taken at its end.
    [[nodiscard]] Forces at(Scalar theta_rad, const Feed& feed) const { return forces(reading_at(theta_rad), feed); }

    /// What the table holds of an engagement, for forces().
    [[nodiscard]] Node between(Scalar theta_rad) const {
        const Reading reading = reading_at(theta_rad);
        Node node;
        for (std::size_t j = 0; j < node.size(); ++j) {
            node[j] = reading[j];
        }
        return node;
    }

    /// `n`: a Node, one as the table stores it, or a reading between such.
    template <typename Entries>
    [[nodiscard]] Forces forces(const Entries& n, const Feed& feed) const {
        const Scalar Gr = feed.G_N_per_mm * feed.r;
        Forces f;
        f.cutting_tangential_N = feed.G_N_per_mm * Scalar(n[a_t]);
        f.tangential_N = f.cutting_tangential_N + Scalar(n[e_t]);
        f.feed_per_ln_r_1_N = Gr * Scalar(n[b_x]);
        f.normal_per_ln_r_1_N = Gr * Scalar(n[b_y]);
        f.edge_feed_N = Scalar(n[e_x]);
        f.edge_normal_N = Scalar(n[e_y]);
        f.feed_N = feed.G_N_per_mm * Scalar(n[a_x]) + f.feed_per_ln_r_1_N + f.edge_feed_N;
        f.normal_N = feed.G_N_per_mm * Scalar(n[a_y]) + f.normal_per_ln_r_1_N + f.edge_normal_N;
        f.ln_t_in_references = feed.ln_f_in_references + Scalar(n[ln_sine]);
        return f;
    }

  private:
    using StoredNode = std::array<Stored<Scalar>, entries>;

    /// The parabola through three nodes, entry by entry as it is asked for.
    struct Reading {
        const StoredNode* nodes;
        Scalar before;
        Scalar here;
        Scalar behind;

        [[nodiscard]] Scalar operator[](std::size_t j) const {
            return before * Scalar(nodes[0][j]) + here * Scalar(nodes[1][j]) + behind * Scalar(nodes[2][j]);
        }
    };
    [[nodiscard]] Reading reading_at(Scalar theta_rad) const {
        const Scalar place = clamp((theta_rad - first_rad) / step_rad_, Scalar(0), Scalar(Nodes - 1));
        const int nearest = static_cast<int>(place + Scalar(0.5F));
        const int middle = nearest < 1 ? 1 : (nearest > Nodes - 2 ? Nodes - 2 : nearest);
        const Scalar x = place - Scalar(middle);
        const Scalar half_x = Scalar(0.5F) * x;
        return {&nodes_[static_cast<std::size_t>(middle - 1)], half_x * (x - Scalar(1)), Scalar(1) - x * x,
                half_x * (x + Scalar(1))};
    }

    [[nodiscard]] Node node_at(Scalar theta_rad, CutSide side, Scalar centre_offset_in_radii) const {
        using elementary::cos;
        using elementary::exp;
        using elementary::log;
        const EngagementIntegrals<Scalar> i =
            engagement_integrals(engagement_angles(side, Scalar(1) - cos(theta_rad), centre_offset_in_radii));
        const Scalar ln_m = log(i.mean_sine);
        const Scalar u = exp(law_.p_s * ln_m);
        const Scalar v = u * exp(law_.p_1 * ln_m);
        const Scalar per_pitch = teeth_ * turns_per_rad<Scalar>;
        const Scalar E_t = law_.K_te_N_per_mm * per_pitch;
        const Scalar E_r = law_.K_re_N_per_mm * per_pitch;
        Node node;
        node[a_t] = u * i.c;
        node[a_x] = u * i.s;
        node[b_x] = v * i.b;
        node[a_y] = -(u * i.b);
        node[b_y] = v * i.s;
        node[e_t] = E_t * i.delta_rad;
        node[e_x] = E_t * i.d + E_r * i.c;
        node[e_y] = E_r * i.d - E_t * i.c;
        node[ln_sine] = has_reference_ ? ln_m : Scalar(0);
        return node;
    }

    std::array<StoredNode, static_cast<std::size_t>(Nodes)> nodes_{};
    CuttingLaw<Scalar> law_{};
    Scalar teeth_{1};
    Scalar step_rad_{1};
    Scalar ln_reference_{0};  // of the law's reference chip thickness
    bool has_reference_ = false;
};

}  // namespace millforce::estimation
