// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/engagement/engagement_estimate.hpp"
#include "estimation/engagement/engagement_table.hpp"
#include "estimation/engagement/immersion_profile.hpp"
#include "estimation/number/literal.hpp"

#include <array>
#include <cstddef>

/// Radial immersion and axial depth of cut from average forces, solved jointly, each with its variance.
///
/// Kim & Chung divide F_ax by F_at (their Eq. 6) and take the depth from F_ax (Eq. 7). Here both unknowns come from one
/// weighted least-squares problem over all forces that are there, because
///  - t_a, K_s and r_1 depend on the immersion that is sought,
///  - F_ax crosses zero in down milling near R_r = 1.4 and gives no depth there, F_at does,
///  - F_ax/F_at is flat in up milling below R_r = 0.3, where only F_ay determines the immersion,
///  - in a diagonal feed a force along a machine axis mixes feed and normal force.
///
/// For each R_r the best depth is known in closed form, and with it J(R_r), the profile likelihood of the immersion
/// alone (immersion_profile.hpp). J is scanned over the whole range, so that no local minimum can catch the solver: at
/// every second of Nodes values, evenly spaced in θ with R_r = 1 − cos θ, and on both sides of every valley that shows.
/// The best node is refined by a cubic through it, its neighbours and one point between them.
/// The immersion's deviation is the larger of the curvature's and of the interval in which J exceeds its minimum by
/// less than 3.84 (95 %); by more where the minimum itself is above 3.84 (side_choice.hpp): a model that explains the
/// forces badly has a wide interval. A flat J gives a wide interval, and a width of more than `widest_interval` no
/// estimate.
///
/// begin() and advance() are resumable: however the steps are divided over calls, the answer has the same bits. A
/// solution takes some 27 steps for a side that is known, twice as many for one that is not, and as many again where
/// a remembered depth is needed; a step is one to three values of J. Memory: two tables of 9 · Nodes scalars. Bodies:
/// engagement_solver_impl.hpp.

namespace millforce::estimation {

template <typename Scalar>
struct EngagementSolverSettings {
    Scalar teeth{0};
    Scalar centre_offset_in_radii{0};  ///< for CutSide::centred
    /// Misfit of the closed law itself, relative to F_at, on each axis force.
    Scalar law_relative_sd{0};
    Scalar largest_immersion{2};
    Scalar widest_interval{literal<Scalar>(1.2L)};  ///< a 95 % interval wider than this is no estimate
    Scalar declared_depth_mm{0};                    ///< axial depth that the program declares; 0: not declared
    Scalar declared_depth_relative_sd{literal<Scalar>(0.05L)};
    Scalar flute_length_mm{0};     ///< no depth is larger; 0: not known
    Scalar least_significance{4};  ///< F_at must exceed this many of its standard deviations
};

template <typename Scalar, int Nodes = 41>
class EngagementSolver {
  public:
    using Table = EngagementTable<Scalar, Nodes>;
    class Search;

    EngagementSolver() = default;
    /// `side`: that of the tool if it is declared; CutSide::centred has tables of its own.
    EngagementSolver(const CuttingLaw<Scalar>& law, const EngagementSolverSettings<Scalar>& settings,
                     CutSide side = CutSide::unknown);

    /// Begins a solution. A declared side is tried first, and the other one only where the declared one fits badly
    /// (J > 9): the other one is taken if its J is smaller by as much. With CutSide::unknown both down and up are tried
    /// and the one that fits better by more than 3.84 is taken; where neither does, the estimate is valid only if both
    /// give the same immersion. Forces that refute both sides give no estimate, and as the interval all immersions at
    /// which the flutes are long enough for F_at.
    ///
    /// If no side fits well with the declared depth (J > 9), the better one is searched once more without it. The depth
    /// is refuted if J is smaller by as much.
    ///
    /// If a side explains the forces, but they determine the depth less than half as well as the `remembered` one is
    /// known, the immersion is searched once more with it. A depth that these forces contradict is not used.
    ///
    /// Where the law is in doubt (law_doubt.hpp), forces that fit it are taken as if they refuted it.
    void begin(Search& search, const AverageForceMeasurement<Scalar>& forces, Scalar feed_per_tooth_mm, CutSide side,
               const KnownDepth<Scalar>& remembered = {}, bool law_is_in_doubt = false) const;

    /// At most so many steps; true when the estimate is there.
    bool advance(Search& search, int steps) const;

    [[nodiscard]] EngagementEstimate<Scalar> solve(const AverageForceMeasurement<Scalar>& forces,
                                                   Scalar feed_per_tooth_mm, CutSide side,
                                                   const KnownDepth<Scalar>& remembered = {}) const;

    /// The forces of a side; unknown is taken for down.
    [[nodiscard]] const Table& table(CutSide side) const { return tables_[side == CutSide::up ? 1 : 0]; }

  private:
    static_assert(Nodes % 2 == 1 && Nodes > 4);
    static constexpr auto nodes = static_cast<std::size_t>(Nodes);

    using Profile = ImmersionProfile<Scalar, Nodes>;
    struct Parabola;

    [[nodiscard]] Scalar largest_angle_rad(CutSide side) const;
    [[nodiscard]] static CutSide first_side(CutSide asked) { return asked == CutSide::unknown ? CutSide::down : asked; }
    [[nodiscard]] bool is_solvable(const AverageForceMeasurement<Scalar>& forces, Scalar feed_per_tooth_mm) const;
    void begin_side(Search& search, CutSide side) const;
    void end_side(Search& search) const;
    void end_sides(Search& search) const;
    void end_without_declared_depth(Search& search) const;
    void end_with_memory(Search& search) const;
    void search_again(Search& search, const KnownDepth<Scalar>& depth) const;
    void withdraw(Search& search) const;
    void step(Search& search) const;

    void scan(Search& search) const;
    void look_at_node(Search& search, std::size_t node) const;
    void look_beside_valley(Search& search) const;
    void begin_refinement(Search& search) const;
    void probe(Search& search) const;
    void try_candidate(Search& search) const;
    Scalar keep_if_better(Search& search, const Parabola& parabola, Scalar steps) const;

    void find_interval(Search& search) const;
    [[nodiscard]] std::size_t low_end(Search& search) const;
    [[nodiscard]] std::size_t high_end(Search& search) const;
    std::size_t last_inside(Search& search, std::size_t node, std::size_t next) const;
    void find_depth(Search& search) const;

    EngagementSolverSettings<Scalar> settings_{};
    Scalar largest_depth_mm_{0};  // the flutes' length, larger by two deviations of K_s
    std::array<Table, 2> tables_{};
};

/// A solution in work. Not thread-safe.
template <typename Scalar, int Nodes>
class EngagementSolver<Scalar, Nodes>::Search {
  public:
    [[nodiscard]] bool done() const { return phase_ == Phase::done; }
    [[nodiscard]] const EngagementEstimate<Scalar>& estimate() const { return estimate_; }
    /// Gives it up: no estimate.
    void cancel() {
        estimate_ = {};
        phase_ = Phase::done;
    }

  private:
    friend class EngagementSolver;
    enum class Phase : unsigned char { scan, valleys, probe, candidate, interval, depth, done };
    enum class With : unsigned char { declared_depth, forces_alone, remembered_depth };

    [[nodiscard]] bool memory_knows_more() const;
    [[nodiscard]] bool is_inside(std::size_t node) const;
    [[nodiscard]] std::size_t end_of_descent(std::size_t node) const;
    [[nodiscard]] std::size_t end_of_ascent(std::size_t node) const;
    [[nodiscard]] Parabola parabola() const;

    Profile profile_{};
    EngagementEstimate<Scalar> estimate_{};
    EngagementEstimate<Scalar> first_{};  // of the side that was tried first; then of the search before
    KnownDepth<Scalar> remembered_{};
    bool law_is_in_doubt_ = false;
    With with_ = With::declared_depth;
    CutSide asked_ = CutSide::unknown;
    CutSide side_ = CutSide::down;
    Phase phase_ = Phase::done;

    std::array<Scalar, nodes> J_{};
    std::size_t node_ = 0;  // of the scan, then of the valleys
    std::size_t best_node_ = 0;
    typename Profile::Value best_{};
    Scalar centre_rad_{0};
    Scalar probe_in_steps_{0};
    Scalar probe_J_{0};
    Scalar curvature_{0};
};

}  // namespace millforce::estimation
