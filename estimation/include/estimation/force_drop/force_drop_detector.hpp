// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/fixed_point.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"
#include "estimation/signal/low_pass_response.hpp"
#include "estimation/signal/revolution_profile.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>

/// The jump of the force where teeth leave (or enter) the workpiece, out of a low-passed, noisy revolution.
///
/// Hwang et al. read the difference of the force before and after the drop. After a low-pass there is no before and
/// after: at 400 rpm a 300 Hz filter spreads the drop over 7°. But the filter is known. A force that is linear on
/// either side of a jump at x = 0 comes out of a linear filter as
///
///   y(x) = c_0 + c_1 x + d · step(x) + e · ramp(x)                                  (LowPassResponse)
///
/// so d, the jump itself, is a linear least-squares coefficient at the true place of the jump; nothing is left of lag
/// or smear. All teeth jump a pitch apart, each by its own amount (runout): the place is common, the coefficients are
/// each tooth's own, and the mean of d over the teeth is the mean tooth force (Eqs. 15–18, any number of teeth in cut).
///
/// The place is found in two steps: at every grid point of a pitch by the jump's estimate as one weighted sum (its
/// square, summed over teeth and forces, is what the fit gains by allowing a jump), then between grid points by the
/// least residual. A mean jump below `least_significance` standard deviations does not count.
///
/// Of other jumps inside the window (the next tooth enters where this one leaves, at 6 teeth and immersion 0.5) the
/// caller may give the size: they are subtracted from the signal first (OtherEdge).
///
/// The window's force is not quite linear: over 12° the second derivative of the tooth force, 2 K a f_z, leaves 1 % of
/// the largest tooth force in d, the same for the same immersion; calibration carries it.
/// A corner that is told wrongly puts the jump elsewhere, and nothing in d shows it: told 17 % too low, an immersion of
/// some 0.6 comes out 0.05 too small. Told 30 % too low or half too high, it shows in the residual
/// (another_filter_fits). Variance: from the residual, with the filter's correlation of the noise. Cost: 2 · Bins ·
/// window multiplications for the search (window ≤ MaxWindow points) and 13 fits of `teeth` windows. No state. Stack: 5
/// · MaxWindow scalars. Bodies: force_drop_detector_impl.hpp.

namespace millforce::estimation {

template <typename Scalar>
struct ForceDropDetectorSettings {
    int teeth{0};                                            ///< N, 1…12, equally spaced
    LowPassResponse<Scalar> response{};                      ///< low-pass from force to sample
    Scalar window_rev{literal<Scalar>(12.0L / 360.0L)};      ///< signal used on either side, after settling
    Scalar least_significance{4};                            ///< jump over its standard deviation
    Scalar largest_settling_pitches{literal<Scalar>(0.3L)};  ///< beyond it jumps of neighbours run together
};

/// A jump and change of slope elsewhere in the pitch, known from the model.
template <typename Scalar>
struct OtherEdge {
    bool present = false;
    Scalar behind_rev{0};  ///< the spindle turns this far from the sought jump to this edge; modulo the pitch
    Scalar step_x_N{0};
    Scalar step_y_N{0};
    Scalar slope_x_N_per_rev{0};
    Scalar slope_y_N_per_rev{0};
};

template <typename Scalar>
struct ForceJump {
    enum class Reason : unsigned char {
        found,
        too_fast,         ///< the tooth passes too quickly for the low-pass
        not_significant,  ///< no jump exceeds the noise
    } reason = Reason::not_significant;
    [[nodiscard]] bool valid() const { return reason == Reason::found; }
    Scalar angle_rev{0};  ///< spindle angle of the jump, 0…1/N
    Measurement<Scalar> x_N{};
    Measurement<Scalar> y_N{};
    Scalar slope_x_N_per_rev{0};  ///< change of slope at the jump
    Scalar slope_y_N_per_rev{0};
    Scalar residual_N2{0};           ///< Σ of both forces' squared residuals over all windows
    Scalar sample_variance_N2{0};    ///< by that residual
    Measurement<Scalar> mean_x_N{};  ///< mean of the whole revolution
    Measurement<Scalar> mean_y_N{};
};

template <typename Scalar, int Bins = 512, int MaxWindow = 128>
class ForceDropDetector {
  public:
    using Profile = RevolutionProfile<Scalar, Bins>;
    using Settings = ForceDropDetectorSettings<Scalar>;

    explicit ForceDropDetector(const Settings& settings = {}) : settings_(settings) {}

    [[nodiscard]] const Settings& settings() const { return settings_; }

    [[nodiscard]] ForceJump<Scalar> detect(const Profile& profile) const;

    /// The jump near a place that is known to two grid points, another edge taken off.
    [[nodiscard]] ForceJump<Scalar> detect_near(const Profile& profile, Scalar angle_rev,
                                                const OtherEdge<Scalar>& other) const;

    /// Whether an edge that the spindle reaches `behind_rev` after the jump acts on the jump's window.
    [[nodiscard]] bool acts_on_window(const Profile& profile, Scalar behind_rev) const;

    /// With half, 1.4 times or twice the stated corner the residual of a jump is less than 0.6 of what it is: the
    /// low-pass is not as told. Cost: 39 fits.
    [[nodiscard]] bool another_filter_fits(const Profile& profile, const ForceJump<Scalar>& jump,
                                           const OtherEdge<Scalar>& other_edge) const;

    /// The jump at a place that is known.
    [[nodiscard]] ForceJump<Scalar> measure_at(const Profile& profile, Scalar angle_rev) const;

  private:
    using Vector4 = Eigen::Matrix<Scalar, 4, 1>;
    using Matrix4 = Eigen::Matrix<Scalar, 4, 4>;
    using Factors = Eigen::LDLT<Matrix4>;

    struct Window;
    struct Fit;

    [[nodiscard]] Window window_of(Scalar seconds_per_bin) const;
    [[nodiscard]] Vector4 regressors(const Window& window, Scalar bins) const;
    static std::size_t index_in(const Window& window, int bin);
    [[nodiscard]] static ForceJump<Scalar> too_fast();
    [[nodiscard]] Scalar place_in_window(const Window& window, Scalar behind_rev) const;
    void take_off(const Window& window, const OtherEdge<Scalar>& other, Scalar bins, Scalar& x_N, Scalar& y_N) const;
    [[nodiscard]] Scalar search(const Profile& profile, const Window& window) const;
    void fill_step_weights(const Window& window,
                           std::array<Scalar, static_cast<std::size_t>(MaxWindow)>& weights) const;
    [[nodiscard]] Fit fit_at(const Profile& profile, const Window& window, const OtherEdge<Scalar>& other,
                             Scalar place_bin) const;
    void add_tooth(const Profile& profile, const Window& window, const OtherEdge<Scalar>& other, Scalar centre,
                   int first, int last, Fit& fit) const;
    [[nodiscard]] ForceJump<Scalar> refine(const Profile& profile, const Window& window, const OtherEdge<Scalar>& other,
                                           Scalar near_bin) const;
    [[nodiscard]] ForceJump<Scalar> judge(const Profile& profile, const Window& window, const Fit& fit,
                                          Scalar place_bin) const;
    void fill_means(const Profile& profile, Scalar inflation, const Fit& fit, ForceJump<Scalar>& jump) const;

    Settings settings_;
};

extern template class ForceDropDetector<float>;
extern template class ForceDropDetector<Fixed>;

}  // namespace millforce::estimation
