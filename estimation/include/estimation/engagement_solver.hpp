#pragma once

#include "estimation/engagement_table.hpp"
#include "estimation/measurement.hpp"

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
/// and J is the profile likelihood of the immersion alone. It is scanned over the whole range (Nodes values, evenly
/// spaced in θ with R_r = 1 − cos θ), so that no local minimum can catch the solver, and the best node is refined.
/// An immersion that another method tells enters J as one more measurement, (R_r − R_told)²/σ².
/// The immersion's deviation is the larger of the curvature's and of the interval in which J exceeds its minimum by
/// less than 3.84 (95 %): a flat J gives a wide interval, and a width of more than `widest_interval` no estimate.
///
/// The forces come from tables (engagement_table.hpp), so that a value of J costs some hundred instructions. A solution
/// takes Nodes + 13 of them for a side that is told and twice as many for one that is not; solve() works them off at
/// once, begin() and advance() in portions, for a tick that must be short.

namespace millforce::estimation {

/// Average forces as the drives show them, along the machine's axes, acting on the workpiece.
template <typename Scalar>
struct AverageForceMeasurement {
    Measurement<Scalar> tangential_N{};  ///< F_at, from the spindle
    Measurement<Scalar> x_N{};           ///< along machine x; not valid where the x drive stands
    Measurement<Scalar> y_N{};           ///< along machine y
    Measurement<Scalar> radial_immersion{};  ///< from elsewhere (force drops), where there is one
    Scalar feed_direction_x{1};          ///< unit vector of the tool's travel relative to the workpiece
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
    Scalar law_relative_sd{static_cast<Scalar>(0.02L)};     ///< misfit of the closed law itself, relative to F_at, on each axis force
    Scalar largest_immersion{2};
    Scalar widest_interval{static_cast<Scalar>(1.2L)};    ///< a 95 % interval wider than this is no estimate
    Scalar declared_depth_mm{0};     ///< axial depth that the program tells; 0: not told
    Scalar declared_depth_relative_sd{static_cast<Scalar>(0.05L)};
    Scalar least_significance{4};    ///< F_at must exceed this many of its standard deviations
};

template <typename Scalar, int Nodes = 41>
class EngagementSolver {
  public:
    using Table = EngagementTable<Scalar, Nodes>;

    EngagementSolver() = default;
    EngagementSolver(const CuttingLaw<Scalar>& law, const EngagementSolverSettings<Scalar>& settings)
        : settings_(settings) {
        for (const CutSide side : {CutSide::down, CutSide::up}) {
            table_of(side).build(law, settings.teeth, side, Scalar(0), largest_angle(side));
        }
    }
    /// For a tool whose side is told; CutSide::centred takes this one.
    EngagementSolver(const CuttingLaw<Scalar>& law, const EngagementSolverSettings<Scalar>& settings, CutSide side)
        : EngagementSolver(law, settings) {
        if (side == CutSide::centred) {
            for (Table& table : tables_) {
                table.build(law, settings.teeth, side, settings.centre_offset_in_radii, largest_angle(side));
            }
        }
    }

  private:
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
        /// The next value is one at a node of the table, which are the cheapest.
        [[nodiscard]] bool scanning() const { return phase_ == Phase::scan; }
        /// Gives it up: no estimate.
        void cancel() {
            estimate_ = {};
            phase_ = Phase::done;
        }

      private:
        friend class EngagementSolver;
        enum class Phase : unsigned char { scan, refine, interval, depth_at_low, depth_at_high, depth, done };
        enum class Point : unsigned char { low, middle, high, candidate };

        Question question_{};
        EngagementEstimate<Scalar> estimate_{};
        EngagementEstimate<Scalar> down_{};
        CutSide asked_ = CutSide::unknown;
        CutSide side_ = CutSide::down;
        Phase phase_ = Phase::done;

        std::array<Scalar, static_cast<std::size_t>(Nodes)> J_{};
        std::size_t node_ = 0;
        std::size_t best_node_ = 0;
        Profile best_{};
        Scalar centre_rad_{0};
        Scalar width_rad_{0};
        Scalar middle_rad_{0};
        Scalar J_low_{0};
        Scalar J_middle_{0};
        Scalar J_high_{0};
        Scalar curvature_{0};
        Point point_ = Point::low;
        int round_ = 0;
    };

    /// Takes up a solution for the given side. With CutSide::unknown both down and up are tried and the one that fits
    /// better by more than 3.84 is taken; where neither does, the estimate is valid only if both give the same immersion.
    void begin(Search& search, const AverageForceMeasurement<Scalar>& forces, Scalar feed_per_tooth_mm,
               CutSide side) const {
        search.asked_ = side;
        search.estimate_ = {};
        search.estimate_.side = side == CutSide::unknown ? CutSide::down : side;
        search.phase_ = Search::Phase::done;
        if (is_solvable(forces, feed_per_tooth_mm)) {
            search.question_ = question_of(forces, feed_per_tooth_mm);
            begin_side(search, search.estimate_.side);
        }
    }

    /// At most so many values of J; true when the estimate is there.
    bool advance(Search& search, int values) const {
        while (values > 0 && !search.done()) {
            values -= search.scanning() ? scan(search, values) : step(search);
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
    static constexpr int rounds_for_curvature = 2;
    static constexpr int rounds = 3;  // narrower parabolas see the rounding of float and the table's grain

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

    [[nodiscard]] Question question_of(const AverageForceMeasurement<Scalar>& forces, Scalar feed_per_tooth_mm) const {
        const Scalar law_variance = square(settings_.law_relative_sd * forces.tangential_N.value);
        Question q;
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
        return q;
    }

    /// One of the steps behind the scan. Returns how many values of J it took, at most.
    int step(Search& s) const {
        switch (s.phase_) {
            case Search::Phase::scan:
            case Search::Phase::done:
                break;
            case Search::Phase::refine:
                refine(s);
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

    [[nodiscard]] Profile profile_at(const Search& s, Scalar theta_rad) const {
        return profile_of(s.question_, table(s.side_).at(theta_rad, s.question_.feed), theta_rad);
    }

    [[nodiscard]] Profile profile_of(const Question& q, const typename Table::Forces& model, Scalar theta_rad) const {
        using elementary::cos;
        const Scalar ln_r_1_variance = q.r_1.variance_at(model.ln_t_in_references);
        const Scalar t_x = q.feed_direction_x;
        const Scalar t_y = q.feed_direction_y;
        // The doubt in r_1 acts along the feed and across it at once; its size per F_at is known at each immersion.
        const Scalar per_F_at = q.tangential_N / model.tangential_N;
        const Scalar along = per_F_at * model.feed_per_ln_r_1_N;
        const Scalar across = per_F_at * model.normal_per_ln_r_1_N;
        const Scalar var_x = q.x_variance + square(t_x * along - t_y * across) * ln_r_1_variance;
        const Scalar var_y = q.y_variance + square(t_y * along + t_x * across) * ln_r_1_variance;
        const Scalar g_x = t_x * model.feed_N - t_y * model.normal_N;
        const Scalar g_y = t_y * model.feed_N + t_x * model.normal_N;
        const Scalar w_t = q.tangential_weight;
        const Scalar w_x = q.has_x ? Scalar(1) / var_x : Scalar(0);
        const Scalar w_y = q.has_y ? Scalar(1) / var_y : Scalar(0);
        // A depth that is told bounds what the forces leave open. K_s and depth act on all forces as one factor, so the
        // factor is known as well as both are.
        const Scalar declared = settings_.declared_depth_mm;
        Scalar declared_weight{0};
        if (declared > Scalar(0)) {
            const Scalar relative_variance = square(settings_.declared_depth_relative_sd) +
                                             q.K_s.variance_at(model.ln_t_in_references);
            declared_weight = Scalar(1) / (square(declared) * relative_variance);
        }
        const Scalar wt_gt = w_t * model.tangential_N;
        const Scalar wx_gx = w_x * g_x;
        const Scalar wy_gy = w_y * g_y;
        Profile profile;
        profile.ln_t_in_references = model.ln_t_in_references;
        profile.information =
            wt_gt * model.tangential_N + wx_gx * g_x + wy_gy * g_y + declared_weight;
        const Scalar wmg = wt_gt * q.tangential_N + wx_gx * q.x_N + wy_gy * q.y_N + declared_weight * declared;
        profile.depth_mm = wmg > Scalar(0) ? wmg / profile.information : Scalar(0);
        const Scalar a_p = profile.depth_mm;
        profile.misfit =
            w_t * square(q.tangential_N - a_p * model.tangential_N) + declared_weight * square(a_p - declared);
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

    /// So many of the nodes at most; returns how many it were.
    int scan(Search& s, int values) const {
        const Table& nodes = table(s.side_);
        const Question q = s.question_;  // out of the reach of what is written to s
        const std::size_t first = s.node_;
        const std::size_t left = s.J_.size() - first;
        const std::size_t end = first + (left < static_cast<std::size_t>(values) ? left : static_cast<std::size_t>(values));
        Profile best = s.best_;
        std::size_t best_node = s.best_node_;
        for (std::size_t k = first; k < end; ++k) {
            const Profile profile =
                profile_of(q, nodes.at_node(k, q.feed), nodes.angle_rad(Scalar(static_cast<int>(k))));
            s.J_[k] = profile.misfit;
            if (k == 0 || profile.misfit < best.misfit) {
                best_node = k;
                best = profile;
            }
        }
        s.node_ = end;
        s.best_node_ = best_node;
        keep(s, best, nodes.angle_rad(Scalar(static_cast<int>(best_node))));
        if (end == s.J_.size()) {
            begin_refinement(s);
        }
        return static_cast<int>(end - first);
    }

    /// The first parabola goes through nodes, which are there already.
    void begin_refinement(Search& s) const {
        const Table& nodes = table(s.side_);
        const std::size_t inner = s.best_node_ < 1 ? 1 : (s.best_node_ > s.J_.size() - 2 ? s.J_.size() - 2 : s.best_node_);
        s.middle_rad_ = nodes.angle_rad(Scalar(static_cast<int>(inner)));
        s.J_low_ = s.J_[inner - 1];
        s.J_middle_ = s.J_[inner];
        s.J_high_ = s.J_[inner + 1];
        s.width_rad_ = nodes.step_rad();
        s.curvature_ = Scalar(0);
        s.round_ = 0;
        s.point_ = Search::Point::candidate;
        s.phase_ = Search::Phase::refine;
    }

    /// Parabolas through three points each, each narrower than the last, from the best node.
    void refine(Search& s) const {
        switch (s.point_) {
            case Search::Point::low:
                s.middle_rad_ = clamp(s.centre_rad_, Table::first_rad + s.width_rad_,
                                      table(s.side_).last_rad() - s.width_rad_);
                s.J_low_ = profile_at(s, s.middle_rad_ - s.width_rad_).misfit;
                s.J_middle_ = s.best_.misfit;
                s.point_ = s.middle_rad_ == s.centre_rad_ ? Search::Point::high : Search::Point::middle;
                break;
            case Search::Point::middle:
                s.J_middle_ = profile_at(s, s.middle_rad_).misfit;
                s.point_ = Search::Point::high;
                break;
            case Search::Point::high:
                s.J_high_ = profile_at(s, s.middle_rad_ + s.width_rad_).misfit;
                s.point_ = Search::Point::candidate;
                break;
            case Search::Point::candidate:
                try_candidate(s);
                break;
        }
    }

    void try_candidate(Search& s) const {
        const Scalar bend = s.J_low_ - Scalar(2) * s.J_middle_ + s.J_high_;
        if (bend > Scalar(0)) {
            s.curvature_ = s.round_ < rounds_for_curvature ? bend / square(s.width_rad_) : s.curvature_;
            const Scalar shift = clamp(Scalar(0.5F) * (s.J_low_ - s.J_high_) / bend, Scalar(-1), Scalar(1));
            const Scalar theta_rad = s.middle_rad_ + shift * s.width_rad_;
            const Profile candidate = profile_at(s, theta_rad);
            if (candidate.misfit <= s.best_.misfit) {
                keep(s, candidate, theta_rad);
            }
            s.width_rad_ *= Scalar(0.5F);
            s.point_ = Search::Point::low;
            if (++s.round_ < rounds) {
                return;
            }
        }
        s.phase_ = Search::Phase::interval;
    }

    void fill_immersion(Search& s) const {
        using elementary::cos;
        using std::sqrt;
        const Table& nodes = table(s.side_);
        const auto& J = s.J_;
        const Scalar threshold = s.best_.misfit + threshold_of_95_percent;
        const auto angle = [&](std::size_t k) { return nodes.angle_rad(Scalar(static_cast<int>(k))); };
        // The nodes beside the estimate, which is never further than two from the best one.
        std::size_t below = s.best_node_ + 2 < J.size() ? s.best_node_ + 2 : J.size() - 1;
        while (below > 0 && !(angle(below) < s.centre_rad_)) {
            --below;
        }
        std::size_t above = below;
        while (above < J.size() - 1 && !(angle(above) > s.centre_rad_)) {
            ++above;
        }
        std::size_t low = 0;
        while (low < below && J[low] > threshold) {
            ++low;
        }
        std::size_t high = J.size() - 1;
        while (high > above && J[high] > threshold) {
            --high;
        }
        const auto crossing = [&](std::size_t inside, std::size_t outside) {
            const Scalar rise = J[outside] - J[inside];
            const Scalar share = rise > Scalar(0) ? clamp((threshold - J[inside]) / rise, Scalar(0), Scalar(1)) : Scalar(0);
            return angle(inside) + (angle(outside) - angle(inside)) * share;
        };
        const Scalar half_by_curvature =
            s.curvature_ > Scalar(0) ? static_cast<Scalar>(1.96L) * sqrt(Scalar(2) / s.curvature_) : nodes.step_rad();
        Scalar theta_low = s.centre_rad_ - half_by_curvature;
        Scalar theta_high = s.centre_rad_ + half_by_curvature;
        if (J[low] <= threshold) {
            const Scalar scanned = low > 0 ? crossing(low, low - 1) : Table::first_rad;
            theta_low = scanned < theta_low ? scanned : theta_low;
        }
        if (J[high] <= threshold) {
            const Scalar scanned = high + 1 < J.size() ? crossing(high, high + 1) : nodes.last_rad();
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
