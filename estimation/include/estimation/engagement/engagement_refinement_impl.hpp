// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of engagement_solver.hpp: the search of one side for the least J, over the nodes and then between them.

#include "estimation/engagement/engagement_solver.hpp"
#include "estimation/engagement/immersion_profile_impl.hpp"

#include <cmath>

namespace millforce::estimation {

/// Every second node.
template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::scan(Search& s) const {
    const std::size_t node = s.node_;
    look_at_node(s, node);
    if (node == 0 || s.J_[node] < s.best_.misfit) {
        s.best_node_ = node;
        s.best_.misfit = s.J_[node];
    }
    s.node_ += 2;
    if (s.node_ >= nodes) {
        s.node_ = s.end_of_descent(0);
        s.phase_ = Search::Phase::valleys;
    }
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::look_at_node(Search& s, std::size_t node) const {
    s.J_[node] = s.profile_.at_node(table(s.side_), node).misfit;
}

/// The last node from here on, of those scanned, up to which J falls.
template <typename Scalar, int Nodes>
std::size_t EngagementSolver<Scalar, Nodes>::Search::end_of_descent(std::size_t node) const {
    while (node + 2 < nodes && J_[node + 2] < J_[node]) {
        node += 2;
    }
    return node;
}
/// … up to which J does not fall.
template <typename Scalar, int Nodes>
std::size_t EngagementSolver<Scalar, Nodes>::Search::end_of_ascent(std::size_t node) const {
    while (node + 2 < nodes && !(J_[node + 2] < J_[node])) {
        node += 2;
    }
    return node;
}

/// The nodes on both sides of a valley that the scan saw.
template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::look_beside_valley(Search& s) const {
    const auto look_at = [&](std::size_t node) {
        look_at_node(s, node);
        if (s.J_[node] < s.best_.misfit) {
            s.best_.misfit = s.J_[node];
            s.best_node_ = node;
        }
    };
    if (s.node_ > 0) {
        look_at(s.node_ - 1);
    }
    if (s.node_ + 1 < nodes) {
        look_at(s.node_ + 1);
    }
    const std::size_t top = s.end_of_ascent(s.node_);
    if (top + 1 < nodes) {
        s.node_ = s.end_of_descent(top);
    } else {
        begin_refinement(s);
    }
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::begin_refinement(Search& s) const {
    if (!(s.best_.misfit >= Scalar(0))) {  // a force is NaN
        end_side(s);
        return;
    }
    const Table& forces = table(s.side_);
    s.best_ = s.profile_.at_node(forces, s.best_node_);
    s.centre_rad_ = forces.angle_rad(Scalar(static_cast<int>(s.best_node_)));
    s.phase_ = Search::Phase::probe;
}

/// J around the best node, in units of the nodes' step: J = J_0 + b u + a u² (+ k u (u² − 1)).
template <typename Scalar, int Nodes>
struct EngagementSolver<Scalar, Nodes>::Parabola {
    std::size_t node;
    Scalar a;
    Scalar b;

    /// Its vertex lies no farther than two steps from the middle: the minimum is not beyond an end of the range.
    [[nodiscard]] bool has_near_vertex() const { return Scalar(4) * a > b && Scalar(4) * a > -b; }
};

template <typename Scalar, int Nodes>
typename EngagementSolver<Scalar, Nodes>::Parabola EngagementSolver<Scalar, Nodes>::Search::parabola() const {
    const std::size_t k = best_node_ < 1 ? 1 : (best_node_ > nodes - 2 ? nodes - 2 : best_node_);
    return {k, halved(J_[k - 1] + J_[k + 1]) - J_[k], halved(J_[k + 1] - J_[k - 1])};
}

/// A point towards the parabola's vertex, and so far from all three nodes that it shows what is no parabola.
template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::probe(Search& s) const {
    constexpr Scalar nearest = literal<Scalar>(0.35L);
    constexpr Scalar farthest = literal<Scalar>(0.65L);
    const Parabola p = s.parabola();
    s.curvature_ = p.a > Scalar(0) ? Scalar(2) * p.a / square(table(s.side_).step_rad()) : Scalar(0);
    if (!p.has_near_vertex()) {
        s.phase_ = Search::Phase::interval;
        return;
    }
    const Scalar vertex = -halved(p.b / p.a);
    s.probe_in_steps_ = vertex < Scalar(0) ? -clamp(-vertex, nearest, farthest) : clamp(vertex, nearest, farthest);
    s.probe_J_ = keep_if_better(s, p, s.probe_in_steps_);
    s.phase_ = Search::Phase::candidate;
}

/// The minimum of the cubic through the three nodes and the probe.
template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::try_candidate(Search& s) const {
    using std::sqrt;
    const Parabola p = s.parabola();
    const Scalar u = s.probe_in_steps_;
    const Scalar rest = s.probe_J_ - s.J_[p.node] - u * (p.b + p.a * u);
    const Scalar slope = p.b / p.a;
    const Scalar cubic = rest / (p.a * u * (u * u - Scalar(1)));
    const Scalar discriminant = Scalar(1) - Scalar(3) * cubic * (slope - cubic);
    if (discriminant > Scalar(0)) {
        const Scalar root = sqrt(discriminant);
        s.curvature_ *= root;
        keep_if_better(s, p, clamp((cubic - slope) / (Scalar(1) + root), Scalar(-1), Scalar(1)));
    }
}

/// Returns J there.
template <typename Scalar, int Nodes>
Scalar EngagementSolver<Scalar, Nodes>::keep_if_better(Search& s, const Parabola& p, Scalar steps) const {
    const Table& forces = table(s.side_);
    const Scalar theta_rad = forces.angle_rad(Scalar(static_cast<int>(p.node))) + steps * forces.step_rad();
    const typename Profile::Value value = s.profile_.at(forces, theta_rad);
    if (value.misfit <= s.best_.misfit) {
        s.best_ = value;
        s.centre_rad_ = theta_rad;
    }
    return value.misfit;
}

}  // namespace millforce::estimation
