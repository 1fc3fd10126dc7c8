#pragma once

#include "estimation/cut_geometry.hpp"
#include "estimation/detail/phasor.hpp"
#include "estimation/flute_profile.hpp"
#include "estimation/least_squares.hpp"
#include "estimation/measurement.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace millforce::estimation {

/// An analog Butterworth low-pass in front of the samples. poles = 0: none.
template <typename Scalar>
struct LowPass {
    int poles = 0;  ///< 0…4
    Scalar cutoff_Hz{0};
};

/// H(f) of the low-pass, f ≥ 0.
template <typename Scalar>
Phasor<Scalar> low_pass_response(const LowPass<Scalar>& filter, Scalar frequency_Hz) {
    using std::sin;
    Phasor<Scalar> response{Scalar(1), Scalar(0)};
    if (filter.poles <= 0 || !(filter.cutoff_Hz > Scalar(0))) {
        return response;
    }
    const Scalar x = frequency_Hz / filter.cutoff_Hz;
    for (int pair = 1; 2 * pair <= filter.poles; ++pair) {
        const Scalar damping = Scalar(2) * sin(pi<Scalar> * Scalar(2 * pair - 1) / Scalar(2 * filter.poles));
        response = response * reciprocal(Phasor<Scalar>{Scalar(1) - x * x, damping * x});
    }
    return filter.poles % 2 == 1 ? response * reciprocal(Phasor<Scalar>{Scalar(1), x}) : response;
}

template <typename Scalar>
struct DepthRange {
    Scalar low_mm{0};
    Scalar high_mm{0};
};

template <typename Scalar>
struct FluteProfileFitSettings {
    int teeth = 4;
    Scalar cutter_radius_mm{5};
    Scalar helix_rad{0};
    Scalar feed_per_tooth_mm{0};  ///< for the trochoid's share of the chip shape; 0: chips of circles
    CutSide side = CutSide::down;
    DepthRange<Scalar> axial{};
    DepthRange<Scalar> radial{};
    LowPass<Scalar> low_pass{};
    Scalar tip_angle_rad{0};
    Scalar tip_angle_sd_rad{0};
    Scalar relative_model_error = Scalar(getenv("RM")?atof(getenv("RM")):0.003);
    Scalar mean_model_error = Scalar(getenv("MM")?atof(getenv("MM")):0.003);
};

template <typename Scalar>
struct DepthEstimate {
    bool valid = false;
    CutSide side = CutSide::down;
    Scalar axial_depth_mm{0};
    Scalar axial_depth_sd_mm{0};
    Scalar radial_depth_mm{0};
    Scalar radial_depth_sd_mm{0};
    Scalar tip_angle_rad{0};  ///< ahead of the encoder's zero, 0…φ_N: where a tooth's tip stands at angle 0
    Scalar misfit{0};         ///< rms residual over rms profile
    Scalar condition_number{0};
};

template <typename Scalar, int Harmonics = 10>
class FluteProfileFit {
  public:
    using Spectrum = ProfileSpectrum<Scalar, Harmonics>;
    using Estimate = DepthEstimate<Scalar>;
    static constexpr int lines = Spectrum::lines;

    FluteProfileFit() = default;
    explicit FluteProfileFit(const FluteProfileFitSettings<Scalar>& settings) : settings_(settings) {}

    [[nodiscard]] Estimate estimate(const Spectrum& spectrum) const {
        if (settings_.side != CutSide::unknown) {
            return estimate_side(spectrum, settings_.side);
        }
        const Estimate down = estimate_side(spectrum, CutSide::down);
        const Estimate up = estimate_side(spectrum, CutSide::up);
        return up.valid && (!down.valid || up.misfit < down.misfit) ? up : down;
    }

  private:
    using Lines = std::array<Phasor<Scalar>, static_cast<std::size_t>(lines)>;

    struct Problem {
        CutSide side;
        Lines data{};
        Lines response{};
        std::array<Scalar, static_cast<std::size_t>(lines)> weight{};
        Scalar energy{0};
        int used = Harmonics;
    };
    struct Point {
        Scalar sweep_rad;
        Scalar engagement_rad;
        Scalar shift_rad;  // N θ₀
    };
    /// The model's lines per unit of A and of B.
    struct Basis {
        Lines chip{};
        Lines edge{};
    };
    struct Coefficients {
        Phasor<Scalar> chip;
        Phasor<Scalar> edge;
    };

    [[nodiscard]] Scalar pitch_rad() const { return Scalar(2) * pi<Scalar> / Scalar(settings_.teeth); }
    [[nodiscard]] static int harmonic(std::size_t line) { return static_cast<int>(line) - Harmonics; }

    [[nodiscard]] Problem problem(const Spectrum& spectrum, CutSide side) const {
        Problem p{.side = side};
        Scalar total{0};
        for (std::size_t l = 0; l < p.data.size(); ++l) {
            total += squared_length(spectrum.line[l]);
        }
        using std::sqrt;
        const Scalar floor2 = square(settings_.relative_model_error) * total;
        p.used = 0;
        for (int k = 0; k <= Harmonics; ++k) {
            const Scalar frequency = Scalar(k * settings_.teeth) * spectrum.spindle_speed_rev_s;
            const auto H = low_pass_response(settings_.low_pass, frequency);
            const auto plus = static_cast<std::size_t>(Harmonics + k);
            const auto minus = static_cast<std::size_t>(Harmonics - k);
            p.response[plus] = H;
            p.response[minus] = conjugate(H);
            const bool use = squared_length(H) > static_cast<Scalar>(0.04L);
            if (use) p.used = k;
            for (const std::size_t l : {plus, minus}) {
                p.data[l] = spectrum.line[l];
                const Scalar m = (k == 0 ? settings_.mean_model_error : settings_.relative_model_error);
                p.weight[l] = use ? Scalar(1) / sqrt(square(Scalar(getenv("FL")?atof(getenv("FL")):0.0003))*total+ square(m) * squared_length(p.data[l])) : Scalar(0);
            }
        }
        for (std::size_t l = 0; l < p.data.size(); ++l) {
            p.energy += square(p.weight[l]) * squared_length(p.data[l]);
        }
        return p;
    }

    /// E(q) = ∫ e^{−iqφ} dφ over the engagement.
    struct Engagement {
        Scalar entry_rad;
        Scalar exit_rad;
    };
    [[nodiscard]] static Engagement engagement(CutSide side, Scalar angle_rad) {
        return side == CutSide::up ? Engagement{Scalar(0), angle_rad} : Engagement{pi<Scalar> - angle_rad, pi<Scalar>};
    }

    /// Spectra of one disc's chip and edge force.
    [[nodiscard]] Basis disc(const Problem& p, const Engagement& cut) const {
        Basis basis;
        const Phasor<Scalar> entry = turned_by(-cut.entry_rad);
        const Phasor<Scalar> exit = turned_by(-cut.exit_rad);
        const Phasor<Scalar> entry_step = power(entry, settings_.teeth);
        const Phasor<Scalar> exit_step = power(exit, settings_.teeth);
        Phasor<Scalar> at_entry{Scalar(1), Scalar(0)};
        Phasor<Scalar> at_exit{Scalar(1), Scalar(0)};
        const Scalar eps = settings_.feed_per_tooth_mm / settings_.cutter_radius_mm;
        const auto E = [&](int q, Phasor<Scalar> from, Phasor<Scalar> to) {
            if (q == 0) return Phasor<Scalar>{cut.exit_rad - cut.entry_rad, Scalar(0)};
            return over_i(from - to) * (Scalar(1) / Scalar(q));
        };
        for (int k = 0; k <= p.used; ++k) {
            for (const int sign : {1, -1}) {
                const int m = sign * k * settings_.teeth;
                const Phasor<Scalar> a = sign > 0 ? at_entry : conjugate(at_entry);
                const Phasor<Scalar> b = sign > 0 ? at_exit : conjugate(at_exit);
                // E(m + 1 + j), j = -2..2
                Phasor<Scalar> e[5];
                Phasor<Scalar> fa = a * conjugate(entry);
                Phasor<Scalar> fb = b * conjugate(exit);
                for (int j = 0; j < 5; ++j) {
                    e[j] = E(m - 1 + j, fa, fb);
                    fa = fa * entry;
                    fb = fb * exit;
                }
                const auto l = static_cast<std::size_t>(Harmonics + sign * k);
                basis.edge[l] = e[2];
                basis.chip[l] = over_i(e[1] - e[3]) * Scalar(0.5F) + e[2] * (eps / Scalar(4)) +
                                (e[0] + e[4]) * (eps / Scalar(8)) -
                                over_i(e[0] - e[4]) * (eps / (Scalar(4) * pitch_rad()));
            }
            at_entry = at_entry * entry_step;
            at_exit = at_exit * exit_step;
        }
        return basis;
    }

    /// T_k = ∫ e^{−ikNψ} dψ over the sweep.
    [[nodiscard]] Lines helix(const Problem& p, Scalar sweep_rad) const {
        Lines T{};
        const Phasor<Scalar> step = turned_by(-Scalar(settings_.teeth) * sweep_rad);
        Phasor<Scalar> at_top = step;
        T[Harmonics] = {sweep_rad, Scalar(0)};
        for (int k = 1; k <= p.used; ++k) {
            const Scalar m = Scalar(k * settings_.teeth);
            const Phasor<Scalar> t = over_i(Phasor<Scalar>{Scalar(1), Scalar(0)} - at_top) * (Scalar(1) / m);
            T[static_cast<std::size_t>(Harmonics + k)] = t;
            T[static_cast<std::size_t>(Harmonics - k)] = conjugate(t);
            at_top = at_top * step;
        }
        return T;
    }

    static Basis combined(const Basis& disc, const Lines& other) {
        Basis b;
        for (std::size_t l = 0; l < other.size(); ++l) {
            b.chip[l] = disc.chip[l] * other[l];
            b.edge[l] = disc.edge[l] * other[l];
        }
        return b;
    }

    /// Orthonormal in the weighted sense; false where there's one direction only.
    static void orthonormalise(const Problem& p, Basis& b) {
        using std::sqrt;
        const auto scale = [&](Lines& v) {
            Scalar n{0};
            for (std::size_t l = 0; l < v.size(); ++l) n += square(p.weight[l]) * squared_length(v[l]);
            const Scalar s = n > Scalar(0) ? Scalar(1) / sqrt(n) : Scalar(0);
            for (auto& x : v) x = x * s;
        };
        scale(b.chip);
        scale(b.edge);
        Phasor<Scalar> dot;
        for (std::size_t l = 0; l < b.chip.size(); ++l) dot += conjugate(b.chip[l]) * b.edge[l] * square(p.weight[l]);
        for (std::size_t l = 0; l < b.chip.size(); ++l) b.edge[l] -= b.chip[l] * dot;
        scale(b.edge);
    }

    /// Energy explained, at the best shift.
    static Scalar best_shift(const Problem& p, const Basis& b, int steps, Scalar& shift) {
        Scalar best{-1};
        for (int s = 0; s < steps; ++s) {
            const Scalar zeta = Scalar(2) * pi<Scalar> * Scalar(s) / Scalar(steps);
            const Scalar e = explained(p, b, zeta);
            if (e > best) {
                best = e;
                shift = zeta;
            }
        }
        return best;
    }
    static Scalar explained(const Problem& p, const Basis& b, Scalar zeta) {
        const Phasor<Scalar> z = turned_by(zeta);
        Phasor<Scalar> zk{Scalar(1), Scalar(0)};
        Phasor<Scalar> c, e;
        for (int k = 0; k <= p.used; ++k) {
            const auto add = [&](std::size_t l, Phasor<Scalar> turn) {
                const Phasor<Scalar> d = p.data[l] * turn * square(p.weight[l]);
                c += conjugate(b.chip[l]) * d;
                e += conjugate(b.edge[l]) * d;
            };
            add(static_cast<std::size_t>(Harmonics + k), zk);
            if (k > 0) add(static_cast<std::size_t>(Harmonics - k), conjugate(zk));
            zk = zk * z;
        }
        return squared_length(c) + squared_length(e);
    }

    [[nodiscard]] Scalar misfit_at(const Problem& p, const Point& x) const {
        Basis b = combined(disc(p, engagement(p.side, x.engagement_rad)), helix(p, x.sweep_rad));
        b = combined(b, p.response);
        orthonormalise(p, b);
        return p.energy - explained(p, b, x.shift_rad);
    }

    struct Limits {
        Scalar sweep_low, sweep_high, engagement_low, engagement_high;
    };
    [[nodiscard]] Limits limits() const {
        using std::acos;
        using std::tan;
        const Scalar per_mm = tan(settings_.helix_rad) / settings_.cutter_radius_mm;
        const auto en = [&](Scalar a_e) {
            return acos(Scalar(1) - clamp(a_e / settings_.cutter_radius_mm, Scalar(0.002F), Scalar(2)));
        };
        return {settings_.axial.low_mm * per_mm, settings_.axial.high_mm * per_mm, en(settings_.radial.low_mm),
                en(settings_.radial.high_mm)};
    }

    static constexpr int grid = 40;
    static constexpr int gridr = 14;
    static constexpr int starts = 4;

    [[nodiscard]] Estimate estimate_side(const Spectrum& spectrum, CutSide side) const {
        const Problem p = problem(spectrum, side);
        const Limits lim = limits();
        std::array<Point, starts> start{};
        std::array<Scalar, starts> value;
        value.fill(Scalar(-1));
        std::array<Lines, grid> T;
        for (int i = 0; i < grid; ++i) {
            T[static_cast<std::size_t>(i)] =
                helix(p, lim.sweep_low + (lim.sweep_high - lim.sweep_low) * (Scalar(i) + Scalar(0.5F)) / Scalar(grid));
        }
        for (int j = 0; j < gridr; ++j) {
            const Scalar en =
                lim.engagement_low + (lim.engagement_high - lim.engagement_low) * (Scalar(j) + Scalar(0.5F)) / Scalar(gridr);
            const Basis d = combined(disc(p, engagement(p.side, en)), p.response);
            for (int i = 0; i < grid; ++i) {
                Basis b = combined(d, T[static_cast<std::size_t>(i)]);
                orthonormalise(p, b);
                Point x{lim.sweep_low + (lim.sweep_high - lim.sweep_low) * (Scalar(i) + Scalar(0.5F)) / Scalar(grid), en,
                        Scalar(0)};
                Scalar e;
                if (settings_.tip_angle_sd_rad > Scalar(0)) {
                    x.shift_rad = settings_.tip_angle_rad * Scalar(settings_.teeth);
                    e = explained(p, b, x.shift_rad);
                } else {
                    e = best_shift(p, b, 32, x.shift_rad);
                }
                std::size_t worst = 0;
                for (std::size_t s = 1; s < start.size(); ++s) {
                    if (value[s] < value[worst]) worst = s;
                }
                if (e > value[worst]) {
                    value[worst] = e;
                    start[worst] = x;
                }
            }
        }
        Estimate best;
        Scalar best_misfit{0};
        for (std::size_t s = 0; s < start.size(); ++s) {
            Estimate e;
            const Scalar m = refine(p, lim, start[s], e);
            if (e.valid && (!best.valid || m < best_misfit)) {
                best = e;
                best_misfit = m;
            }
        }
        return best;
    }

    #ifndef HATS
#define HATS 2
#endif
    static constexpr int hats = HATS;
    static constexpr int linear = 4 + 2 * hats;
    using Fit = LeastSquares<Scalar, linear + 3>;
    using LinearFit = LeastSquares<Scalar, linear>;
    using Laws = std::array<Lines, 2 + hats>;
    static Scalar knob(const char* n, float d) { const char* v = getenv(n); return Scalar(v ? atof(v) : d); }
    static Scalar knot(int h) { return h == 0 ? knob("G1", 0.2F) : h == 1 ? knob("G2", 0.5F) : knob("G3", 0.1F); }
    static Scalar hat(int h, Scalar g) { return g < knot(h) ? Scalar(1) - g / knot(h) : Scalar(0); }

    /// hat integrals
    [[nodiscard]] Lines hat_lines(const Problem& p, Engagement cut, int h) const {
        using std::asin;
        const Scalar a = asin(knot(h));
        Lines sum{};
        const auto low = [&](Scalar x, Scalar y) { return x < y ? x : y; };
        const Engagement parts[2] = {{cut.entry_rad, low(cut.exit_rad, a)},
                                     {-low(-cut.entry_rad, -(pi<Scalar> - a)), cut.exit_rad}};
        for (const Engagement& part : parts) {
            if (!(part.exit_rad > part.entry_rad)) continue;
            const Basis b = disc(p, part);
            for (std::size_t l = 0; l < sum.size(); ++l) sum[l] += b.edge[l] - b.chip[l] * (Scalar(1) / knot(h));
        }
        return sum;
    }
    [[nodiscard]] Laws laws(const Problem& p, Scalar en) const {
        Laws all{};
        const Engagement cut = engagement(p.side, en);
        const Basis b = disc(p, cut);
        all[0] = b.chip;
        all[1] = b.edge;
        for (int h = 0; h < hats; ++h) all[static_cast<std::size_t>(2 + h)] = hat_lines(p, cut, h);
        return all;
    }
    template <typename F>
    static void add_priors(F& fit, Scalar scale) {
        for (int h = 0; h < 2 * hats; ++h) fit.add_prior(4 + h, Scalar(0), Scalar(1) / (knob("HP", 0.3F) * scale));
        fit.add_prior(2, Scalar(0), Scalar(1) / (knob("EP", 2.F) * scale));
        fit.add_prior(3, Scalar(0), Scalar(1) / (knob("EP", 2.F) * scale));
    }
    /// everything after the disc: helix, filter, shift
    [[nodiscard]] Lines after(const Problem& p, const Point& x) const {
        const Lines T = helix(p, x.sweep_rad);
        Lines all{};
        const Phasor<Scalar> z = turned_by(-x.shift_rad);
        Phasor<Scalar> zk{Scalar(1), Scalar(0)};
        for (int k = 0; k <= p.used; ++k) {
            const auto plus = static_cast<std::size_t>(Harmonics + k);
            const auto minus = static_cast<std::size_t>(Harmonics - k);
            all[plus] = zk * p.response[plus] * T[plus];
            all[minus] = conjugate(zk) * p.response[minus] * T[minus];
            zk = zk * z;
        }
        return all;
    }
    using Coefs = std::array<Phasor<Scalar>, 2 + hats>;
    /// the weighted misfit with the linear coefficients solved
    Scalar solve_linear(const Problem& p, const Laws& laws, const Lines& after, Scalar scale, Coefs& c) const {
        LinearFit fit;
        for (std::size_t l = 0; l < p.data.size(); ++l) {
            if (!(p.weight[l] > Scalar(0))) continue;
            typename LinearFit::Vector re, im;
            for (std::size_t b = 0; b < laws.size(); ++b) {
                const auto u = laws[b][l] * after[l];
                const int j = 2 * static_cast<int>(b);
                re(j) = u.re; re(j + 1) = -u.im; im(j) = u.im; im(j + 1) = u.re;
            }
            fit.add(re, p.data[l].re, p.weight[l]);
            fit.add(im, p.data[l].im, p.weight[l]);
        }
        add_priors(fit, scale);
        const auto s = fit.solve(Scalar(1e6));
        for (std::size_t b = 0; b < c.size(); ++b) c[b] = {s.parameters(2 * static_cast<int>(b)), s.parameters(2 * static_cast<int>(b) + 1)};
        return fit.residual_sum_of_squares();
    }

    void gather(const Problem& p, const Point& x, Scalar scale, const Coefs& c, const Laws& laws, const Lines& post, Fit& fit) const {
        using std::cos;
        using std::sin;
        const Engagement cut = engagement(p.side, x.engagement_rad);
        const Scalar edge = p.side == CutSide::up ? cut.exit_rad : cut.entry_rad;
        const Scalar eps = settings_.feed_per_tooth_mm / settings_.cutter_radius_mm;
        const Scalar g = sin(edge) + eps * (Scalar(0.5F) * square(cos(edge)) - sin(edge) * cos(edge) / pitch_rad());
        Phasor<Scalar> at_edge = c[0] * g + c[1];
        for (int h = 0; h < hats; ++h) at_edge += c[static_cast<std::size_t>(2 + h)] * hat(h, g);
        const Lines T = helix(p, x.sweep_rad);
        for (std::size_t l = 0; l < p.data.size(); ++l) {
            if (!(p.weight[l] > Scalar(0))) continue;
            const int k = harmonic(l);
            const Scalar m = Scalar(k * settings_.teeth);
            Phasor<Scalar> disc_sum;
            typename Fit::Vector re, im;
            for (std::size_t b = 0; b < laws.size(); ++b) {
                const auto u = laws[b][l] * post[l];
                const int j = 2 * static_cast<int>(b);
                re(j) = u.re; re(j + 1) = -u.im; im(j) = u.im; im(j + 1) = u.re;
                disc_sum += c[b] * laws[b][l];
            }
            const Phasor<Scalar> model = disc_sum * post[l];
            const Phasor<Scalar> turn = turned_by(-x.shift_rad * Scalar(k)) * p.response[l];
            const Phasor<Scalar> by_sweep = disc_sum * turned_by(-m * x.sweep_rad) * turn;
            const Phasor<Scalar> by_engagement = at_edge * turned_by(-(m + Scalar(1)) * edge) * post[l];
            const Phasor<Scalar> by_shift = Phasor<Scalar>{model.im, -model.re} * Scalar(k);
            re(linear) = by_sweep.re; im(linear) = by_sweep.im;
            re(linear + 1) = by_engagement.re; im(linear + 1) = by_engagement.im;
            re(linear + 2) = by_shift.re; im(linear + 2) = by_shift.im;
            // Around the present coefficients: the solution is their new value.
            const Phasor<Scalar> r = p.data[l];
            fit.add(re, r.re, p.weight[l]);
            fit.add(im, r.im, p.weight[l]);
        }
        add_priors(fit, scale);
    }

    [[nodiscard]] Scalar shift_prior(const Point& x) const {
        if (!(settings_.tip_angle_sd_rad > Scalar(0))) return Scalar(0);
        const Scalar n = Scalar(settings_.teeth);
        return square((settings_.tip_angle_rad * n - x.shift_rad) / (n * settings_.tip_angle_sd_rad));
    }
    [[nodiscard]] Scalar refine(const Problem& p, const Limits& lim, Point x, Estimate& e) const {
        using std::cos;
        using std::sin;
        using std::sqrt;
        using std::tan;
        Coefs c{};
        Laws law = laws(p, x.engagement_rad);
        Lines post = after(p, x);
        Scalar scale{1e9F};
        // the chip coefficient sets the scale of the priors
        (void)solve_linear(p, law, post, scale, c);
        {
            Basis b{law[0], law[1]};
            Scalar uu{0}, dd{0};
            for (std::size_t l = 0; l < p.data.size(); ++l) {
                uu += square(p.weight[l]) * squared_length(law[0][l] * post[l]);
                dd += square(p.weight[l]) * squared_length(p.data[l]);
            }
            scale = sqrt(dd / uu);
        }
        Scalar J = solve_linear(p, law, post, scale, c) + shift_prior(x);
        LeastSquaresSolution<Scalar, linear + 3> s;
        for (int it = 0; it < 15; ++it) {
            Fit fit;
            if (settings_.tip_angle_sd_rad > Scalar(0)) {
                const Scalar n = Scalar(settings_.teeth);
                fit.add_prior(linear + 2, settings_.tip_angle_rad * n - x.shift_rad, Scalar(1) / (n * settings_.tip_angle_sd_rad));
            }
            gather(p, x, scale, c, law, post, fit);
            s = fit.solve(Scalar(1e6));
            Scalar share{1};
            bool better = false;
            Point trial = x;
            for (int half = 0; half < 5 && !better; ++half) {
                const Scalar most = static_cast<Scalar>(0.2L);
                trial.sweep_rad = clamp(x.sweep_rad + share * clamp(s.parameters(linear), -most, most), lim.sweep_low, lim.sweep_high);
                trial.engagement_rad = clamp(x.engagement_rad + share * clamp(s.parameters(linear + 1), -most, most),
                                             lim.engagement_low, lim.engagement_high);
                trial.shift_rad = x.shift_rad + share * clamp(s.parameters(linear + 2), -most, most);
                law = laws(p, trial.engagement_rad);
                post = after(p, trial);
                const Scalar Jt = solve_linear(p, law, post, scale, c) + shift_prior(trial);
                if (Jt < J) {
                    better = true;
                    J = Jt;
                }
                share *= Scalar(0.4F);
            }
            if (!better) break;
            x = trial;
        }
        const Scalar R = settings_.cutter_radius_mm;
        const Scalar mm = R / tan(settings_.helix_rad);
        e.valid = true;
        e.side = p.side;
        e.axial_depth_mm = x.sweep_rad * mm;
        e.axial_depth_sd_mm = s.standard_error(linear) * mm;
        e.radial_depth_mm = R * (Scalar(1) - cos(x.engagement_rad));
        e.radial_depth_sd_mm = s.standard_error(linear + 1) * R * sin(x.engagement_rad);
        e.tip_angle_rad = x.shift_rad / Scalar(settings_.teeth);
        e.misfit = sqrt(J / p.energy);
        e.condition_number = s.condition_number;
        return J;
    }

    FluteProfileFitSettings<Scalar> settings_;
};

}  // namespace millforce::estimation
