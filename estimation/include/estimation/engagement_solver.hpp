#pragma once

#include "estimation/cutting_law.hpp"
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
    Scalar smallest_immersion{static_cast<Scalar>(0.02L)};
    Scalar largest_immersion{2};
    Scalar widest_interval{static_cast<Scalar>(1.2L)};    ///< a 95 % interval wider than this is no estimate
    Scalar declared_depth_mm{0};     ///< axial depth that the program tells; 0: not told
    Scalar declared_depth_relative_sd{static_cast<Scalar>(0.05L)};
    Scalar least_significance{4};    ///< F_at must exceed this many of its standard deviations
};

template <typename Scalar, int Nodes = 48>
class EngagementSolver {
  public:
    EngagementSolver() = default;
    EngagementSolver(const CuttingLaw<Scalar>& law, const EngagementSolverSettings<Scalar>& settings)
        : law_(law), settings_(settings) {}

    /// Solves for the given side. With CutSide::unknown both down and up are tried and the one that fits better by
    /// more than 3.84 is taken; where neither does, the estimate is valid only if both give the same immersion.
    [[nodiscard]] EngagementEstimate<Scalar> solve(const AverageForceMeasurement<Scalar>& forces,
                                                   Scalar feed_per_tooth_mm, CutSide side) const {
        if (side != CutSide::unknown) {
            return solve_side(forces, feed_per_tooth_mm, side);
        }
        const auto down = solve_side(forces, feed_per_tooth_mm, CutSide::down);
        const auto up = solve_side(forces, feed_per_tooth_mm, CutSide::up);
        return choose_side(down, up);
    }

    /// Average forces in the feed frame per mm of axial depth, at an immersion.
    [[nodiscard]] AverageForcesWithDoubt<Scalar> forces_per_mm(CutSide side, Scalar radial_immersion,
                                                               Scalar feed_per_tooth_mm) const {
        return average_forces_with_doubt(
            law_, CutConditions<Scalar>{
                      feed_per_tooth_mm, Scalar(1),
                      engagement_angles(side, radial_immersion, settings_.centre_offset_in_radii), settings_.teeth});
    }

  private:
    /// One value of the profile: the depth that fits best at an immersion, and how badly it fits.
    struct Profile {
        Scalar misfit{0};
        Scalar depth_mm{0};
        Scalar tangential_per_mm_N{0};
        Scalar information{0};  // Σ w g²: inverse variance of the depth at this immersion
        Scalar ln_K_s_variance{0};
    };

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

    [[nodiscard]] Profile profile_at(const AverageForceMeasurement<Scalar>& forces, Scalar feed_per_tooth_mm,
                                     CutSide side, Scalar theta_rad) const {
        using elementary::cos;
        const Scalar immersion = Scalar(1) - cos(theta_rad);
        const auto model = forces_per_mm(side, immersion, feed_per_tooth_mm);
        const Scalar t_x = forces.feed_direction_x;
        const Scalar t_y = forces.feed_direction_y;
        const Scalar law_variance = square(settings_.law_relative_sd * forces.tangential_N.value);
        // The doubt in r_1 acts along the feed and across it at once; its size per F_at is known at each immersion.
        const Scalar per_F_at = forces.tangential_N.value / model.mean.tangential_N;
        const auto axis_variance = [&](Scalar along, Scalar across) {
            const Scalar by_r_1 =
                per_F_at * (along * model.per_ln_r_1.feed_N + across * model.per_ln_r_1.normal_N);
            return law_variance + square(by_r_1) * model.coefficients.ln_r_1_variance;
        };
        Scalar wmg{0};
        Scalar wgg{0};
        const auto gather = [&](const Measurement<Scalar>& m, Scalar g, Scalar extra_variance) {
            if (m.valid) {
                const Scalar w = Scalar(1) / (m.variance + extra_variance);
                wmg += w * m.value * g;
                wgg += w * g * g;
            }
        };
        const Scalar g_x = t_x * model.mean.feed_N - t_y * model.mean.normal_N;
        const Scalar g_y = t_y * model.mean.feed_N + t_x * model.mean.normal_N;
        const Scalar var_x = axis_variance(t_x, -t_y);
        const Scalar var_y = axis_variance(t_y, t_x);
        gather(forces.tangential_N, model.mean.tangential_N, Scalar(0));
        gather(forces.x_N, g_x, var_x);
        gather(forces.y_N, g_y, var_y);
        // A depth that is told bounds what the forces leave open. K_s and depth act on all forces as one factor, so the
        // factor is known as well as both are.
        const Scalar declared = settings_.declared_depth_mm;
        const Scalar declared_weight =
            declared > Scalar(0)
                ? Scalar(1) / (square(declared) * (square(settings_.declared_depth_relative_sd) +
                                                   model.coefficients.ln_K_s_variance))
                : Scalar(0);
        wmg += declared_weight * declared;
        wgg += declared_weight;
        Profile profile;
        profile.tangential_per_mm_N = model.mean.tangential_N;
        profile.ln_K_s_variance = model.coefficients.ln_K_s_variance;
        profile.information = wgg;
        profile.depth_mm = wmg > Scalar(0) ? wmg / wgg : Scalar(0);
        const auto misfit = [&](const Measurement<Scalar>& m, Scalar g, Scalar extra_variance) {
            return m.valid ? square(m.value - profile.depth_mm * g) / (m.variance + extra_variance) : Scalar(0);
        };
        const Measurement<Scalar>& told = forces.radial_immersion;
        profile.misfit = misfit(forces.tangential_N, model.mean.tangential_N, Scalar(0)) +
                         misfit(forces.x_N, g_x, var_x) + misfit(forces.y_N, g_y, var_y) +
                         declared_weight * square(profile.depth_mm - declared) +
                         (told.valid ? square(immersion - told.value) / told.variance : Scalar(0));
        return profile;
    }

    [[nodiscard]] bool is_solvable(const AverageForceMeasurement<Scalar>& forces, Scalar feed_per_tooth_mm) const {
        using std::sqrt;
        const Measurement<Scalar>& F_at = forces.tangential_N;
        return F_at.valid && feed_per_tooth_mm > Scalar(0) && F_at.value > Scalar(0) &&
               F_at.value > settings_.least_significance * sqrt(F_at.variance) &&
               (forces.x_N.valid || forces.y_N.valid || forces.radial_immersion.valid);
    }

    [[nodiscard]] EngagementEstimate<Scalar> solve_side(const AverageForceMeasurement<Scalar>& forces,
                                                        Scalar feed_per_tooth_mm, CutSide side) const {
        using elementary::acos;
        EngagementEstimate<Scalar> estimate;
        estimate.side = side;
        if (!is_solvable(forces, feed_per_tooth_mm)) {
            return estimate;
        }
        const Scalar first = acos(Scalar(1) - settings_.smallest_immersion);
        const Scalar step = (largest_angle(side) - first) / Scalar(Nodes - 1);
        std::array<Scalar, static_cast<std::size_t>(Nodes)> J{};
        std::size_t best = 0;
        for (std::size_t k = 0; k < J.size(); ++k) {
            J[k] = profile_at(forces, feed_per_tooth_mm, side, first + step * Scalar(k)).misfit;
            best = J[k] < J[best] ? k : best;
        }
        Scalar centre = first + step * Scalar(best);
        Scalar curvature{0};
        Profile at_best = refine(forces, feed_per_tooth_mm, side, {first, largest_angle(side)}, step, centre, curvature);
        fill_immersion(estimate, J, first, step, centre, at_best.misfit, curvature);
        fill_depth(estimate, forces, feed_per_tooth_mm, side, at_best);
        return estimate;
    }

    struct Range {
        Scalar low;
        Scalar high;
    };

    /// Three parabolas through three points each, each narrower than the last, from the best node.
    [[nodiscard]] Profile refine(const AverageForceMeasurement<Scalar>& forces, Scalar feed_per_tooth_mm, CutSide side,
                                 Range range, Scalar step, Scalar& centre, Scalar& curvature) const {
        Profile best = profile_at(forces, feed_per_tooth_mm, side, centre);
        Scalar width = step;
        for (int round = 0; round < 4; ++round) {
            const Scalar middle = clamp(centre, range.low + width, range.high - width);
            const Scalar J_low = profile_at(forces, feed_per_tooth_mm, side, middle - width).misfit;
            const Scalar J_mid = profile_at(forces, feed_per_tooth_mm, side, middle).misfit;
            const Scalar J_high = profile_at(forces, feed_per_tooth_mm, side, middle + width).misfit;
            const Scalar bend = J_low - Scalar(2) * J_mid + J_high;
            if (!(bend > Scalar(0))) {
                break;
            }
            curvature = bend / square(width);
            const Scalar shift = clamp(Scalar(0.5F) * (J_low - J_high) / bend, Scalar(-1), Scalar(1)) * width;
            const Profile candidate = profile_at(forces, feed_per_tooth_mm, side, middle + shift);
            if (candidate.misfit <= best.misfit) {
                best = candidate;
                centre = middle + shift;
            }
            width *= static_cast<Scalar>(0.35L);
        }
        return best;
    }

    template <std::size_t Count>
    void fill_immersion(EngagementEstimate<Scalar>& estimate, const std::array<Scalar, Count>& J, Scalar first,
                        Scalar step, Scalar centre, Scalar least, Scalar curvature) const {
        using elementary::cos;
        using elementary::sin;
        using std::sqrt;
        const Scalar threshold = least + static_cast<Scalar>(3.84L);
        std::size_t low = 0;
        while (J[low] > threshold && first + step * Scalar(low + 1) < centre) {
            ++low;
        }
        std::size_t high = Count - 1;
        while (J[high] > threshold && first + step * Scalar(high - 1) > centre) {
            --high;
        }
        const auto crossing = [&](std::size_t inside, std::size_t outside) {
            const Scalar rise = J[outside] - J[inside];
            const Scalar share = rise > Scalar(0) ? clamp((threshold - J[inside]) / rise, Scalar(0), Scalar(1)) : Scalar(0);
            return first + step * (Scalar(inside) + (Scalar(outside) - Scalar(inside)) * share);
        };
        const bool low_open = J[low] <= threshold;
        const bool high_open = J[high] <= threshold;
        const Scalar half_by_curvature = curvature > Scalar(0) ? static_cast<Scalar>(1.96L) * sqrt(Scalar(2) / curvature) : step;
        Scalar theta_low = centre - half_by_curvature;
        Scalar theta_high = centre + half_by_curvature;
        if (low_open) {
            const Scalar scanned = low > 0 ? crossing(low, low - 1) : first;
            theta_low = scanned < theta_low ? scanned : theta_low;
        }
        if (high_open) {
            const Scalar scanned = high + 1 < Count ? crossing(high, high + 1) : first + step * Scalar(Count - 1);
            theta_high = scanned > theta_high ? scanned : theta_high;
        }
        theta_low = theta_low < Scalar(0) ? Scalar(0) : theta_low;
        theta_high = theta_high > pi<Scalar> ? pi<Scalar> : theta_high;
        estimate.radial_immersion = Scalar(1) - cos(centre);
        estimate.radial_immersion_low = Scalar(1) - cos(theta_low);
        estimate.radial_immersion_high = Scalar(1) - cos(theta_high);
        const Scalar width = estimate.radial_immersion_high - estimate.radial_immersion_low;
        estimate.radial_immersion_sd = width / static_cast<Scalar>(3.92L);
        estimate.misfit = least;
        estimate.solved = true;
        estimate.immersion_valid = width <= settings_.widest_interval;
    }

    /// Depth at the estimate; its deviation adds what the immersion's doubt and K_s leave open.
    void fill_depth(EngagementEstimate<Scalar>& estimate, const AverageForceMeasurement<Scalar>& forces,
                    Scalar feed_per_tooth_mm, CutSide side, const Profile& best) const {
        using elementary::acos;
        using std::sqrt;
        if (!(best.information > Scalar(0)) || !(best.depth_mm > Scalar(0))) {
            return;
        }
        const auto depth_at = [&](Scalar immersion) {
            const Scalar theta = acos(Scalar(1) - clamp(immersion, settings_.smallest_immersion, Scalar(2)));
            return profile_at(forces, feed_per_tooth_mm, side, theta).depth_mm;
        };
        estimate.depth_at_low_mm = depth_at(estimate.radial_immersion_low);
        estimate.depth_at_high_mm = depth_at(estimate.radial_immersion_high);
        const Scalar spread = (estimate.depth_at_high_mm - estimate.depth_at_low_mm) / static_cast<Scalar>(3.92L);
        estimate.axial_depth_mm = best.depth_mm;
        estimate.axial_depth_sd_mm = sqrt(square(spread) + Scalar(1) / best.information +
                                          square(best.depth_mm) * best.ln_K_s_variance);
        estimate.depth_valid =
            estimate.immersion_valid && estimate.axial_depth_sd_mm < estimate.axial_depth_mm;
    }

    [[nodiscard]] static EngagementEstimate<Scalar> choose_side(const EngagementEstimate<Scalar>& down,
                                                                const EngagementEstimate<Scalar>& up) {
        const Scalar advantage = up.misfit - down.misfit;
        if (down.immersion_valid != up.immersion_valid) {
            const EngagementEstimate<Scalar>& only = down.immersion_valid ? down : up;
            const EngagementEstimate<Scalar>& other = down.immersion_valid ? up : down;
            if (other.misfit - only.misfit > static_cast<Scalar>(3.84L)) {
                return only;
            }
        }
        if (advantage > static_cast<Scalar>(3.84L)) {
            return down;
        }
        if (advantage < static_cast<Scalar>(-3.84L)) {
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

    CuttingLaw<Scalar> law_{};
    EngagementSolverSettings<Scalar> settings_{};
};

}  // namespace millforce::estimation
