// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/engagement/engagement_table.hpp"
#include "estimation/number/measurement.hpp"

#include <array>
#include <cmath>

/// Radial immersion and axial depth of cut from average forces, solved jointly, each with its variance.
///
/// Kim & Chung divide F_ax by F_at (their Eq. 6) and take the depth from F_ax (Eq. 7). Here both unknowns come from one
/// weighted least-squares problem over all forces that are there, because
///  - t_a, K_s and r_1 depend on the immersion that is sought,
///  - F_ax crosses zero in down milling near R_r = 1.4 and tells no depth there, F_at does,
///  - F_ax/F_at is flat in up milling below R_r = 0.3, where only F_ay knows the immersion,
///  - in a diagonal feed a force along a machine axis mixes feed and normal force.
///
/// Every force is proportional to the depth: m_i = a_p g_i(R_r). So for each R_r the best depth is known,
///   a_p = Σ w m g / Σ w g²,   J(R_r) = Σ w (m − a_p g)²,   w = 1/σ²,
/// and J is the profile likelihood of the immersion alone. It is scanned over the whole range, so that no local minimum
/// can catch the solver: at every second of Nodes values, evenly spaced in θ with R_r = 1 − cos θ, and on both sides of
/// every valley that shows. The best node is refined by a cubic through it, its neighbours and one point between them.
/// An immersion that another method tells enters J as one more measurement, (R_r − R_told)²/σ².
/// The immersion's deviation is the larger of the curvature's and of the interval in which J exceeds its minimum by
/// less than 3.84 (95 %): a flat J gives a wide interval, and a width of more than `widest_interval` no estimate.
///
/// The forces come from tables (engagement_table.hpp), so that a value of J costs some hundred instructions at a node
/// and twice as many between nodes: two nodes count as one value. A solution takes 20 values for a side that is told,
/// one more for every valley but the first, and twice as many for a side that is not; solve() works them off at once,
/// begin() and advance() in portions, for a tick that must be short.

namespace millforce::estimation {

/// Average forces as the drives show them, along the machine's axes, acting on the workpiece.
template <typename Scalar>
struct AverageForceMeasurement {
    Measurement<Scalar> tangential_N{};      ///< F_at, from the spindle
    Measurement<Scalar> x_N{};               ///< along machine x; not valid where the x drive stands
    Measurement<Scalar> y_N{};               ///< along machine y
    Measurement<Scalar> radial_immersion{};  ///< from elsewhere (force drops), where there is one
    Scalar feed_direction_x{1};              ///< unit vector of the tool's travel relative to the workpiece
    Scalar feed_direction_y{0};
};

template <typename Scalar>
struct EngagementEstimate {
    bool solved = false;  ///< there was something to solve: the 95 % intervals below hold, however wide
    bool immersion_valid = false;
    Scalar radial_immersion{0};  ///< R_r = a_e/R, 0…2
    Scalar radial_immersion_sd{0};
    Scalar radial_immersion_low{0};  ///< 95 % interval
    Scalar radial_immersion_high{2};
    Scalar engagement_rad{0};  ///< θ of radial_immersion, R_r = 1 − cos θ, and of the interval's ends
    Scalar engagement_low_rad{0};
    Scalar engagement_high_rad{pi<Scalar>};

    bool depth_valid = false;
    Scalar axial_depth_mm{0};
    Scalar axial_depth_sd_mm{0};
    Scalar depth_at_low_mm{0};   ///< the depth that goes with radial_immersion_low: both err together
    Scalar depth_at_high_mm{0};  ///< … with radial_immersion_high

    CutSide side = CutSide::unknown;
    Scalar misfit{0};  ///< J at the estimate: far above 4 means that the law does not describe these forces
};

template <typename Scalar>
struct EngagementSolverSettings {
    Scalar teeth{4};
    Scalar centre_offset_in_radii{0};  ///< for CutSide::centred
    Scalar law_relative_sd{
        static_cast<Scalar>(0.02L)};  ///< misfit of the closed law itself, relative to F_at, on each axis force
    Scalar largest_immersion{2};
    Scalar widest_interval{static_cast<Scalar>(1.2L)};  ///< a 95 % interval wider than this is no estimate
    Scalar declared_depth_mm{0};                        ///< axial depth that the program tells; 0: not told
    Scalar declared_depth_relative_sd{static_cast<Scalar>(0.05L)};
    Scalar least_significance{4};  ///< F_at must exceed this many of its standard deviations
};

template <typename Scalar, int Nodes = 41>
class EngagementSolver {
  public:
    using Table = EngagementTable<Scalar, Nodes>;

    EngagementSolver() = default;
    [[gnu::cold]] EngagementSolver(const CuttingLaw<Scalar>& law, const EngagementSolverSettings<Scalar>& settings)
        : settings_(settings) {
        for (const CutSide side : {CutSide::down, CutSide::up}) {
            table_of(side).build(law, settings.teeth, side, Scalar(0), largest_angle(side));
        }
    }
    /// For a tool whose side is told; CutSide::centred takes this one.
    [[gnu::cold]] EngagementSolver(const CuttingLaw<Scalar>& law, const EngagementSolverSettings<Scalar>& settings,
                                   CutSide side)
        : EngagementSolver(law, settings) {
        if (side == CutSide::centred) {
            for (Table& table : tables_) {
                table.build(law, settings.teeth, side, settings.centre_offset_in_radii, largest_angle(side));
            }
        }
    }

  private:
    static_assert(Nodes % 2 == 1 && Nodes > 4);
    static constexpr auto nodes = static_cast<std::size_t>(Nodes);
    static constexpr Scalar not_known = static_cast<Scalar>(1e9L);  // no interval reaches so high

    /// What all values of J have in common.
    struct Question {
        typename Table::Feed feed{};
        Scalar tangential_N{0};
        Scalar tangential_weight{0};
        Scalar x_N{0};
        Scalar x_variance{0};  // with the law's, without r_1's, which depends on the immersion
        Scalar y_N{0};
        Scalar y_variance{0};
        Scalar feed_direction_x{1};
        Scalar feed_direction_y{0};
        typename Table::Doubt K_s{};
        typename Table::Doubt r_1{};
        bool has_x = false;
        bool has_y = false;
        Measurement<Scalar> radial_immersion{};
    };

    /// One value of the profile: the depth that fits best at an immersion, and how badly it fits.
    struct Profile {
        Scalar misfit{0};
        Scalar depth_mm{0};
        Scalar information{0};  // Σ w g²: inverse variance of the depth at this immersion
        Scalar ln_t_in_references{0};
    };

  public:
    /// A solution in work. Not thread-safe.
    class Search {
      public:
        [[nodiscard]] bool done() const { return phase_ == Phase::done; }
        [[nodiscard]] const EngagementEstimate<Scalar>& estimate() const { return estimate_; }
        /// What the last question that could be solved was asked for.
        [[nodiscard]] const typename Table::Feed& feed() const { return question_.feed; }
        /// Gives it up: no estimate.
        void cancel() {
            estimate_ = {};
            phase_ = Phase::done;
        }

      private:
        friend class EngagementSolver;
        enum class Phase : unsigned char {
            scan,
            valleys,
            probe,
            candidate,
            low_end,
            high_end,
            interval,
            depth_at_low,
            depth_at_high,
            depth,
            done
        };

        Question question_{};
        EngagementEstimate<Scalar> estimate_{};
        EngagementEstimate<Scalar> down_{};
        CutSide asked_ = CutSide::unknown;
        CutSide side_ = CutSide::down;
        Phase phase_ = Phase::done;

        std::array<Scalar, nodes> J_{};  // not_known where the scan has had no reason to look
        std::size_t node_ = 0;
        std::size_t best_node_ = 0;
        std::size_t low_node_ = 0;  // the interval's last nodes inside
        std::size_t high_node_ = 0;
        Profile best_{};
        Scalar centre_rad_{0};
        Scalar probe_in_steps_{0};
        Scalar probe_J_{0};
        Scalar curvature_{0};
    };

    /// Takes up a solution for the given side. With CutSide::unknown both down and up are tried and the one that fits
    /// better by more than 3.84 is taken; where neither does, the estimate is valid only if both give the same
    /// immersion.
    void begin(Search& search, const AverageForceMeasurement<Scalar>& forces, Scalar feed_per_tooth_mm,
               CutSide side) const {
        search.asked_ = side;
        begin_side(search, side == CutSide::unknown ? CutSide::down : side);
        if (is_solvable(forces, feed_per_tooth_mm)) {
            set_question(search.question_, forces, feed_per_tooth_mm);
        } else {
            search.phase_ = Search::Phase::done;
        }
    }

    /// At most so many values of J; true when the estimate is there.
    bool advance(Search& search, int values) const {
        while (values > 0 && !search.done()) {
            values -= search.phase_ == Search::Phase::scan ? scan(search, values) : step(search);
        }
        return search.done();
    }

    [[nodiscard]] EngagementEstimate<Scalar> solve(const AverageForceMeasurement<Scalar>& forces,
                                                   Scalar feed_per_tooth_mm, CutSide side) const {
        Search search;
        solve(search, forces, feed_per_tooth_mm, side);
        return search.estimate();
    }

    /// The same in a memory that is there already.
    void solve(Search& search, const AverageForceMeasurement<Scalar>& forces, Scalar feed_per_tooth_mm,
               CutSide side) const {
        begin(search, forces, feed_per_tooth_mm, side);
        while (!advance(search, Nodes)) {
        }
    }

    /// The forces of a side; unknown is taken for down.
    [[nodiscard]] const Table& table(CutSide side) const { return tables_[side == CutSide::up ? 1 : 0]; }

  private:
    static constexpr Scalar threshold_of_95_percent = static_cast<Scalar>(3.84L);

    [[nodiscard]] Table& table_of(CutSide side) { return tables_[side == CutSide::up ? 1 : 0]; }

    [[nodiscard]] Scalar largest_angle(CutSide side) const {
        using elementary::acos;
        Scalar limit = settings_.largest_immersion;
        if (side == CutSide::centred) {
            const Scalar offset = settings_.centre_offset_in_radii;
            const Scalar reach = Scalar(2) * (Scalar(1) - (offset < Scalar(0) ? -offset : offset));
            limit = limit < reach ? limit : reach;
        }
        return acos(Scalar(1) - limit);
    }

    [[nodiscard]] bool is_solvable(const AverageForceMeasurement<Scalar>& forces, Scalar feed_per_tooth_mm) const {
        const Measurement<Scalar>& F_at = forces.tangential_N;
        return F_at.valid && feed_per_tooth_mm > Scalar(0) && F_at.value > Scalar(0) &&
               square(F_at.value) > square(settings_.least_significance) * F_at.variance &&
               (forces.x_N.valid || forces.y_N.valid || forces.radial_immersion.valid);
    }

    void begin_side(Search& s, CutSide side) const {
        s.side_ = side;
        s.estimate_ = {};
        s.estimate_.side = side;
        s.node_ = 0;
        s.best_node_ = 0;
        s.phase_ = Search::Phase::scan;
    }

    void set_question(Question& q, const AverageForceMeasurement<Scalar>& forces, Scalar feed_per_tooth_mm) const {
        const Scalar law_variance = square(settings_.law_relative_sd * forces.tangential_N.value);
        q.feed = tables_[0].feed(feed_per_tooth_mm);
        q.tangential_N = forces.tangential_N.value;
        q.tangential_weight = Scalar(1) / forces.tangential_N.variance;
        q.x_N = forces.x_N.value;
        q.x_variance = forces.x_N.variance + law_variance;
        q.y_N = forces.y_N.value;
        q.y_variance = forces.y_N.variance + law_variance;
        q.feed_direction_x = forces.feed_direction_x;
        q.feed_direction_y = forces.feed_direction_y;
        q.K_s = tables_[0].doubt_of_K_s();
        q.r_1 = tables_[0].doubt_of_r_1();
        q.has_x = forces.x_N.valid;
        q.has_y = forces.y_N.valid;
        q.radial_immersion = forces.radial_immersion;
    }

    /// One of the steps behind the scan. Returns how many values it took.
    int step(Search& s) const {
        switch (s.phase_) {
            case Search::Phase::scan:
            case Search::Phase::done:
                break;
            case Search::Phase::valleys:
                look_beside_valley(s);
                break;
            case Search::Phase::probe:
                probe(s);
                break;
            case Search::Phase::candidate:
                try_candidate(s);
                s.phase_ = Search::Phase::low_end;
                break;
            case Search::Phase::low_end:
                find_low_end(s);
                s.phase_ = Search::Phase::high_end;
                break;
            case Search::Phase::high_end:
                find_high_end(s);
                s.phase_ = Search::Phase::interval;
                break;
            case Search::Phase::interval:
                fill_immersion(s);
                s.phase_ = Search::Phase::depth_at_low;
                break;
            case Search::Phase::depth_at_low:
                s.estimate_.depth_at_low_mm = profile_at(s, s.estimate_.engagement_low_rad).depth_mm;
                s.phase_ = Search::Phase::depth_at_high;
                break;
            case Search::Phase::depth_at_high:
                s.estimate_.depth_at_high_mm = profile_at(s, s.estimate_.engagement_high_rad).depth_mm;
                s.phase_ = Search::Phase::depth;
                break;
            case Search::Phase::depth:
                fill_depth(s);
                end_side(s);
                break;
        }
        return 1;
    }

    [[nodiscard, gnu::noinline]] Profile profile_at(const Search& s, Scalar theta_rad) const {
        return profile_of(s.question_, table(s.side_).at(theta_rad, s.question_.feed), theta_rad);
    }

    [[nodiscard]] Profile profile_of(const Question& q, const typename Table::Forces& model, Scalar theta_rad) const {
        using elementary::cos;
        const Scalar t_x = q.feed_direction_x;
        const Scalar t_y = q.feed_direction_y;
        // The doubt in r_1 acts along the feed and across it at once; its size per F_at is known at each immersion.
        const Scalar ln_r_1_variance = q.r_1.variance_at(model.ln_t_in_references);
        const Scalar per_F_at = q.tangential_N / model.tangential_N;
        const Scalar along = per_F_at * model.feed_per_ln_r_1_N;
        const Scalar across = per_F_at * model.normal_per_ln_r_1_N;
        Scalar g_x{0};
        Scalar w_x{0};
        Scalar g_y{0};
        Scalar w_y{0};
        const Scalar w_t = q.tangential_weight;
        const Scalar wt_gt = w_t * model.tangential_N;
        Scalar information = wt_gt * model.tangential_N;
        Scalar wmg = wt_gt * q.tangential_N;
        if (q.has_x) {
            g_x = t_x * model.feed_N - t_y * model.normal_N;
            w_x = Scalar(1) / (q.x_variance + square(t_x * along - t_y * across) * ln_r_1_variance);
            const Scalar wx_gx = w_x * g_x;
            information += wx_gx * g_x;
            wmg += wx_gx * q.x_N;
        }
        if (q.has_y) {
            g_y = t_y * model.feed_N + t_x * model.normal_N;
            w_y = Scalar(1) / (q.y_variance + square(t_y * along + t_x * across) * ln_r_1_variance);
            const Scalar wy_gy = w_y * g_y;
            information += wy_gy * g_y;
            wmg += wy_gy * q.y_N;
        }
        // A depth that is told bounds what the forces leave open. K_s and depth act on all forces as one factor, so the
        // factor is known as well as both are.
        const Scalar declared = settings_.declared_depth_mm;
        Scalar declared_weight{0};
        if (declared > Scalar(0)) {
            const Scalar relative_variance =
                square(settings_.declared_depth_relative_sd) + q.K_s.variance_at(model.ln_t_in_references);
            declared_weight = Scalar(1) / (square(declared) * relative_variance);
            information += declared_weight;
            wmg += declared_weight * declared;
        }
        const Scalar a_p = wmg > Scalar(0) ? wmg / information : Scalar(0);
        Profile profile;
        profile.depth_mm = a_p;
        profile.information = information;
        profile.ln_t_in_references = model.ln_t_in_references;
        profile.misfit = w_t * square(q.tangential_N - a_p * model.tangential_N);
        if (declared > Scalar(0)) {
            profile.misfit += declared_weight * square(a_p - declared);
        }
        if (q.has_x) {
            profile.misfit += w_x * square(q.x_N - a_p * g_x);
        }
        if (q.has_y) {
            profile.misfit += w_y * square(q.y_N - a_p * g_y);
        }
        if (q.radial_immersion.valid) {
            const Scalar immersion = Scalar(1) - cos(theta_rad);
            profile.misfit += square(immersion - q.radial_immersion.value) / q.radial_immersion.variance;
        }
        return profile;
    }

    static void keep(Search& s, const Profile& profile, Scalar theta_rad) {
        s.best_ = profile;
        s.centre_rad_ = theta_rad;
    }

    [[nodiscard]] static Scalar node_rad(const Table& table, std::size_t k) {
        return table.angle_rad(Scalar(static_cast<int>(k)));
    }

    [[nodiscard]] Profile profile_at_node(const Question& q, const Table& table, std::size_t k) const {
        return profile_of(q, table.at_node(k, q.feed), node_rad(table, k));
    }

    /// Every second node, two for a value: one between nodes takes twice as long. Returns how many values it took.
    int scan(Search& s, int values) const {
        const Table& forces = table(s.side_);
        const Question q = s.question_;  // out of the reach of what is written to s
        const std::size_t most = s.node_ + 4 * static_cast<std::size_t>(values);
        const std::size_t end = most < nodes ? most : nodes;
        const std::size_t first = s.node_;
        Scalar least = s.best_.misfit;
        std::size_t best_node = s.best_node_;
        std::size_t k = first;
        for (; k < end; k += 2) {
            const Scalar J = profile_at_node(q, forces, k).misfit;
            s.J_[k] = J;
            s.J_[k + 1 < nodes ? k + 1 : k - 1] = not_known;
            if (k == 0 || J < least) {
                best_node = k;
                least = J;
            }
        }
        s.best_.misfit = least;
        s.best_node_ = best_node;
        s.node_ = k;
        if (k >= nodes) {
            s.node_ = down_from(s, 0);
            s.phase_ = Search::Phase::valleys;
        }
        return static_cast<int>((k - first + 2) / 4);
    }

    /// The first node from here on, of those scanned, behind which J rises.
    [[nodiscard]] static std::size_t down_from(const Search& s, std::size_t k) {
        while (k + 2 < nodes && s.J_[k + 2] < s.J_[k]) {
            k += 2;
        }
        return k;
    }
    /// … or falls, or the last one.
    [[nodiscard]] static std::size_t up_from(const Search& s, std::size_t k) {
        while (k + 2 < nodes && !(s.J_[k + 2] < s.J_[k])) {
            k += 2;
        }
        return k;
    }

    /// The nodes on both sides of a valley that the scan saw.
    void look_beside_valley(Search& s) const {
        const auto look_at = [&](std::size_t k) {
            look_at_node(s, k);
            if (s.J_[k] < s.best_.misfit) {
                s.best_.misfit = s.J_[k];
                s.best_node_ = k;
            }
        };
        if (s.node_ > 0) {
            look_at(s.node_ - 1);
        }
        if (s.node_ + 1 < nodes) {
            look_at(s.node_ + 1);
        }
        const std::size_t top = up_from(s, s.node_);
        if (top + 1 < nodes) {
            s.node_ = down_from(s, top);
        } else {
            begin_refinement(s);
        }
    }

    [[gnu::noinline]] void look_at_node(Search& s, std::size_t k) const {
        s.J_[k] = profile_at_node(s.question_, table(s.side_), k).misfit;
    }

    void begin_refinement(Search& s) const {
        if (!(s.best_.misfit >= Scalar(0))) {  // a force that is no number
            end_side(s);
            return;
        }
        s.best_.information = Scalar(0);  // has to be looked up again if no other immersion is better
        s.centre_rad_ = node_rad(table(s.side_), s.best_node_);
        s.phase_ = Search::Phase::probe;
    }

    /// J beside the best node, in units of the nodes' step: J = J_0 + b u + a u² (+ k u (u² − 1)).
    struct Parabola {
        std::size_t node;
        Scalar a;
        Scalar b;
    };
    [[nodiscard]] static Parabola parabola_of(const Search& s) {
        const std::size_t k = s.best_node_ < 1 ? 1 : (s.best_node_ > nodes - 2 ? nodes - 2 : s.best_node_);
        return {k, halved(s.J_[k - 1] + s.J_[k + 1]) - s.J_[k], halved(s.J_[k + 1] - s.J_[k - 1])};
    }

    /// A point towards the parabola's vertex, and so far from all three nodes that it tells what is no parabola.
    void probe(Search& s) const {
        const Parabola p = parabola_of(s);
        s.curvature_ = p.a > Scalar(0) ? Scalar(2) * p.a / square(table(s.side_).step_rad()) : Scalar(0);
        if (!(Scalar(4) * p.a > p.b && Scalar(4) * p.a > -p.b)) {  // it falls to an end of the range
            s.phase_ = Search::Phase::low_end;
            return;
        }
        constexpr Scalar nearest = static_cast<Scalar>(0.35L);
        constexpr Scalar farthest = static_cast<Scalar>(0.65L);
        const Scalar vertex = Scalar(-0.5F) * p.b / p.a;
        s.probe_in_steps_ = vertex < Scalar(0) ? -clamp(-vertex, nearest, farthest) : clamp(vertex, nearest, farthest);
        s.probe_J_ = keep_if_better(s, p, s.probe_in_steps_);
        s.phase_ = Search::Phase::candidate;
    }

    /// The minimum of the cubic through the three nodes and the probe.
    void try_candidate(Search& s) const {
        using std::sqrt;
        const Parabola p = parabola_of(s);
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
    Scalar keep_if_better(Search& s, const Parabola& p, Scalar steps) const {
        const Table& forces = table(s.side_);
        const Scalar theta_rad = node_rad(forces, p.node) + steps * forces.step_rad();
        const Profile profile = profile_at(s, theta_rad);
        if (profile.misfit <= s.best_.misfit) {
            keep(s, profile, theta_rad);
        }
        return profile.misfit;
    }

    /// The outermost node below the estimate that lies within the interval, or the nearest one.
    void find_low_end(Search& s) const {
        const Table& forces = table(s.side_);
        if (!(s.best_.information > Scalar(0))) {
            s.best_ = profile_at_node(s.question_, forces, s.best_node_);
        }
        // The estimate is less than two nodes from the best one.
        std::size_t below = s.best_node_ + 1 < nodes ? s.best_node_ + 1 : nodes - 1;
        while (below > 0 && !(node_rad(forces, below) < s.centre_rad_)) {
            --below;
        }
        std::size_t low = 0;
        while (low < below && !is_inside(s, low)) {
            ++low;
        }
        s.low_node_ = low > 0 ? last_inside(s, low, low - 1) : low;
    }
    /// … and above it.
    void find_high_end(Search& s) const {
        const Table& forces = table(s.side_);
        std::size_t above = s.best_node_ > 0 ? s.best_node_ - 1 : 0;
        while (above < nodes - 1 && !(node_rad(forces, above) > s.centre_rad_)) {
            ++above;
        }
        std::size_t high = nodes - 1;
        while (high > above && !is_inside(s, high)) {
            --high;
        }
        s.high_node_ = high + 1 < nodes ? last_inside(s, high, high + 1) : high;
    }
    /// Of a node and the next one outwards, where the scan has left that out.
    std::size_t last_inside(Search& s, std::size_t node, std::size_t next) const {
        if (!is_inside(s, node) || s.J_[next] != not_known) {
            return node;
        }
        look_at_node(s, next);
        return is_inside(s, next) ? next : node;
    }
    [[nodiscard]] static bool is_inside(const Search& s, std::size_t node) {
        return s.J_[node] <= s.best_.misfit + threshold_of_95_percent;
    }

    void fill_immersion(Search& s) const {
        using elementary::cos;
        using std::sqrt;
        const Table& forces = table(s.side_);
        const auto& J = s.J_;
        const std::size_t low = s.low_node_;
        const std::size_t high = s.high_node_;
        const Scalar threshold = s.best_.misfit + threshold_of_95_percent;
        const auto crossing = [&](std::size_t inside, std::size_t outside) {
            const Scalar rise = J[outside] - J[inside];
            const Scalar share =
                rise > Scalar(0) ? clamp((threshold - J[inside]) / rise, Scalar(0), Scalar(1)) : Scalar(0);
            const Scalar inside_rad = node_rad(forces, inside);
            return inside_rad + (node_rad(forces, outside) - inside_rad) * share;
        };
        const Scalar half_by_curvature =
            s.curvature_ > Scalar(0) ? static_cast<Scalar>(1.96L) * sqrt(Scalar(2) / s.curvature_) : forces.step_rad();
        Scalar theta_low = s.centre_rad_ - half_by_curvature;
        Scalar theta_high = s.centre_rad_ + half_by_curvature;
        if (is_inside(s, low)) {
            const Scalar scanned = low > 0 ? crossing(low, low - 1) : Table::first_rad;
            theta_low = scanned < theta_low ? scanned : theta_low;
        }
        if (is_inside(s, high)) {
            const Scalar scanned = high + 1 < nodes ? crossing(high, high + 1) : forces.last_rad();
            theta_high = scanned > theta_high ? scanned : theta_high;
        }
        EngagementEstimate<Scalar>& e = s.estimate_;
        e.engagement_rad = s.centre_rad_;
        e.engagement_low_rad = theta_low < Scalar(0) ? Scalar(0) : theta_low;
        e.engagement_high_rad = theta_high > pi<Scalar> ? pi<Scalar> : theta_high;
        e.radial_immersion = Scalar(1) - cos(e.engagement_rad);
        e.radial_immersion_low = Scalar(1) - cos(e.engagement_low_rad);
        e.radial_immersion_high = Scalar(1) - cos(e.engagement_high_rad);
        const Scalar width = e.radial_immersion_high - e.radial_immersion_low;
        e.radial_immersion_sd = width / static_cast<Scalar>(3.92L);
        e.misfit = s.best_.misfit;
        e.solved = true;
        e.immersion_valid = width <= settings_.widest_interval;
    }

    /// Depth at the estimate; its deviation adds what the immersion's doubt and K_s leave open.
    void fill_depth(Search& s) const {
        using std::sqrt;
        EngagementEstimate<Scalar>& e = s.estimate_;
        if (!(s.best_.information > Scalar(0)) || !(s.best_.depth_mm > Scalar(0))) {
            e.depth_at_low_mm = Scalar(0);
            e.depth_at_high_mm = Scalar(0);
            return;
        }
        const Scalar spread = (e.depth_at_high_mm - e.depth_at_low_mm) / static_cast<Scalar>(3.92L);
        e.axial_depth_mm = s.best_.depth_mm;
        const Scalar by_K_s = square(s.best_.depth_mm) * s.question_.K_s.variance_at(s.best_.ln_t_in_references);
        e.axial_depth_sd_mm = sqrt(square(spread) + Scalar(1) / s.best_.information + by_K_s);
        e.depth_valid = e.immersion_valid && e.axial_depth_sd_mm < e.axial_depth_mm;
    }

    void end_side(Search& s) const {
        if (s.asked_ != CutSide::unknown) {
            s.phase_ = Search::Phase::done;
        } else if (s.side_ == CutSide::down) {
            s.down_ = s.estimate_;
            begin_side(s, CutSide::up);
        } else {
            s.estimate_ = choose_side(s.down_, s.estimate_);
            s.phase_ = Search::Phase::done;
        }
    }

    [[nodiscard]] static EngagementEstimate<Scalar> choose_side(const EngagementEstimate<Scalar>& down,
                                                                const EngagementEstimate<Scalar>& up) {
        const Scalar advantage = up.misfit - down.misfit;
        if (down.immersion_valid != up.immersion_valid) {
            const EngagementEstimate<Scalar>& only = down.immersion_valid ? down : up;
            const EngagementEstimate<Scalar>& other = down.immersion_valid ? up : down;
            if (other.misfit - only.misfit > threshold_of_95_percent) {
                return only;
            }
        }
        if (advantage > threshold_of_95_percent) {
            return down;
        }
        if (advantage < -threshold_of_95_percent) {
            return up;
        }
        EngagementEstimate<Scalar> either = advantage < Scalar(0) ? up : down;
        const Scalar apart = down.radial_immersion - up.radial_immersion;
        const Scalar within = static_cast<Scalar>(1.96L) * (down.radial_immersion_sd + up.radial_immersion_sd);
        either.side = CutSide::unknown;
        if (!(square(apart) <= square(within))) {
            either.immersion_valid = false;
            either.depth_valid = false;
        }
        return either;
    }

    EngagementSolverSettings<Scalar> settings_{};
    std::array<Table, 2> tables_{};
};

}  // namespace millforce::estimation
