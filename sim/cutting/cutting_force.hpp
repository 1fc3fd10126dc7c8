// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "cutting/angle_units.hpp"
#include "cutting/bottom_edge.hpp"
#include "cutting/chip_thickness.hpp"
#include "cutting/cutter.hpp"
#include "cutting/cutting_coefficients.hpp"
#include "cutting/engagement_map.hpp"

namespace millforce::sim {

/// How finely the edges are divided, and their way.
struct EdgeResolution {
    std::size_t axial_slices = 20;  ///< over the flute length, 1…500; at most 1000 in all
    /// More slices where the lag ψ of one, or the arc κ of one on a ball, would exceed this; 0.001…0.2.
    double largest_angle_per_slice_rad = 2.0 * degree;
    double largest_turn_rad = 3.0 * degree;  ///< from one force to the next, in a plant
};

struct CuttingForceOptions {
    ChipModel chip_model = ChipModel::trochoidal;
    EdgeResolution resolution{};
    std::optional<BottomEdge> bottom_edge{};  ///< off by default
};

/// Force on the WORKPIECE, in the feed frame: x along the feed, y its normal (φ = 0), z from the tip up the spindle's
/// axis, right-handed. With φ the angle of an edge element:
///   F_x = F_t cos φ + F_r sin φ,  F_y = −F_t sin φ + F_r cos φ;
/// fz > 0 lifts the workpiece (a right-hand helix does), fz < 0 presses it down (a ball end, an inclined insert).
/// The tool feels the opposite of all three.
struct CuttingLoad {
    double fx_N = 0.0;
    double fy_N = 0.0;
    double fz_N = 0.0;
    double spindle_torque_Nm = 0.0;                         ///< Σ r F_t: what the spindle must deliver, > 0 in cut
    std::array<double, Cutter::max_teeth> tooth_force_N{};  ///< √(F_x² + F_y²) of each tooth alone
};

/// The plant's cutting force: the edges of all teeth, cut into axial slices, each a separate oblique cut (Guan et al.,
/// section 3.1). Everything is summed; no closed form of an average enters.
///
/// A slice cuts where its angle φ = θ − position of the tooth − ψ(z) and its height are in material: one rule for the
/// paper's cases 3.1.2–3.1.3, which contain a misprint (climb milling (1)b mixes π with θ_st). The part of a slice in
/// material is found bin by bin, so it comes and goes smoothly; chip thickness and pressure are taken at that part's
/// centre. On that part of width b (axial), with κ = 90° but for inserts and balls:
///   h = h_plan sin κ,  F_t = K_tc h b/sin κ + K_te b/sin κ, and so on; then
///   radial F_r sin κ + F_a cos κ,  axial F_a sin κ − F_r cos κ.
/// h_plan is the least of the chips left by the last N teeth and never negative: with runout a tooth can miss, and the
/// next takes more. Edge forces act only where h > 0.
///
/// The midpoint rule within a slice errs by (lag per slice)²/24 to (lag per slice)²/6 of the chip's part: averages over
/// 400 random cuts stay within 0.04 % of the exact ones (tests/sim/cutting).
///
/// Cost: no allocation after construction; no state, so that one object serves several threads. With 4 teeth × 20
/// slices some 1.2 µs (60° of engagement) to 2.7 µs (a slot, trochoidal) per call on a 2.5 GHz server core; a size
/// effect with two exponents adds up to 1.8 µs. 16 KB of stack.
class CuttingForce {
  public:
    /// Throws InputError where the cutter, the coefficients, the bottom edge or the resolution are not valid.
    CuttingForce(const Cutter& cutter, const CuttingCoefficients& coefficients,
                 const CuttingForceOptions& options = {});

    /// The load at one spindle angle (tooth 0 at φ = θ, growing as the spindle turns; any finite value) and one feed
    /// per tooth (mean over the teeth: feed speed over N × spindle speed). No feed, or feed away from the material,
    /// gives no chip and no force. Throws InputError where angle or feed is not finite.
    CuttingLoad load(double spindle_angle_rad, double feed_per_tooth_mm, const EngagementMap& map) const;
    /// The same, with the map's own bounds at hand.
    CuttingLoad load(double spindle_angle_rad, double feed_per_tooth_mm, const EngagementMap& map,
                     const EngagementBounds& bounds) const;

    const Cutter& cutter() const { return cutter_; }
    const CuttingCoefficients& coefficients() const { return coefficients_; }
    const CuttingForceOptions& options() const { return options_; }
    std::size_t slice_count() const { return slices_.size(); }

    /// New coefficients (another material, a worn edge) for the same cutter. Throws InputError.
    void set_coefficients(const CuttingCoefficients& coefficients);

  private:
    static constexpr std::size_t most_slices = 1000;

    struct Slice {
        double bottom_mm;
        double top_mm;
        double middle_mm;
        double sin_lag;  ///< at the middle
        double cos_lag;
        double radius_mm;
        double sin_kappa;
        double cos_kappa;
        double edge_per_height;
    };
    struct ToothAngle {
        double bins;  ///< place of the tip, 0…bin_count
        double sine;
        double cosine;
    };
    /// Of each slice of one edge: the height in material, and its moment about the slice's middle.
    struct InCut {
        std::array<double, most_slices> width_mm;
        std::array<double, most_slices> moment_mm2;
        std::size_t first;  ///< slices [first, end) hold numbers, the others are not written
        std::size_t end;
    };
    struct ToothLoad {
        double fx_N = 0.0;
        double fy_N = 0.0;
        double fz_N = 0.0;
        double torque_Nmm = 0.0;
    };
    struct ElementForce {
        double tangential_N;
        double radial_N;
        double axial_N;
    };

    void build_slices();
    void build_teeth();
    Slice slice_between(double bottom_mm, double top_mm) const;
    double runout_mm(std::size_t tooth, std::size_t slice) const {
        return runout_mm_[slice * Cutter::max_teeth + tooth];
    }
    void find_parts_in_cut(double tip_bins, const EngagementMap& map, const EngagementBounds& bounds,
                           InCut& in_cut) const;
    void add_part(double low_mm, double high_mm, double weight, InCut& in_cut) const;
    double chip_in_plane_mm(std::size_t tooth, std::size_t slice, double sin_phi, double cos_phi,
                            double feed_per_radian_mm) const;
    ElementForce element_force(double chip_mm, double section_mm2, double edge_mm) const;
    ToothLoad flank_load(std::size_t tooth, const ToothAngle& tip, double feed_per_radian_mm,
                         const InCut& in_cut) const;
    void add_bottom_edge(std::size_t tooth, const ToothAngle& tip, double feed_per_radian_mm, const EngagementMap& map,
                         ToothLoad& total) const;

    Cutter cutter_;
    CuttingCoefficients coefficients_;
    CuttingForceOptions options_;
    std::vector<Slice> slices_;
    std::vector<double> runout_mm_;
    std::array<double, Cutter::max_teeth> position_rad_{};
    /// [k][m − 1]: the m-th tooth ahead of tooth k, and the angle between the two.
    std::array<std::array<std::size_t, Cutter::max_teeth>, Cutter::max_teeth> tooth_ahead_{};
    std::array<std::array<double, Cutter::max_teeth>, Cutter::max_teeth> gap_rad_{};
    double lag_rad_per_mm_ = 0.0;
    double mm_per_bin_ = 0.0;  ///< height along an edge per bin of lag; 0 without helix
    bool has_runout_ = false;
    bool has_size_effect_ = false;
};

}  // namespace millforce::sim
