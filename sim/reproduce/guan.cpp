// SPDX-License-Identifier: Apache-2.0
#include "reproduce/guan_checks.hpp"
#include "reproduce/guan_cuts.hpp"
#include "reproduce/reproduction.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

/// Guan et al.: the plant's force model. What the paper prints, the five cases of its Fig. 6, flank and bottom edge
/// separately.

namespace millforce::sim {
namespace guan_reproduction {
namespace {

using Series = Plot::Series;
using Judged = Figure::Judged;

/// The bottom ("chisel") edge: the only numbers that the paper prints of its model.
void add_chisel_edge(Reproduction& result) {
    const BottomEdge edge = bottom_edge();
    const BottomEdgeForce force = orthogonal_components(edge, resultant_N);
    const double shear_rad = orthogonal_shear_angle_rad(rake_rad, chip_compression);
    auto& figures = result.figures;
    figures.push_back(
        {"Section 3.2: shear angle φ_c at a chip compression of 1.8", "°", 30.2, shear_rad / degree, Judged::difference,
         0.05, 0.0,
         "the rake of 5° is not printed: it is the whole degree that gives this angle. The next three rows test it."});
    figures.push_back(
        {"Section 3.2: friction angle, by Lee & Shaffer's 45° + γ − φ_c (the paper does not say where it "
         "comes from)",
         "°", 19.8, 45.0 + rake_rad / degree - shear_rad / degree, Judged::difference, 0.05});
    figures.push_back({"Section 3.2: chip edge F_x, of F = 68 N (printed to ± 0.5 N)", "N", 65.6, force.cutting_N,
                       Judged::difference, 0.2});
    figures.push_back({"Section 3.2: chip edge F_z, of F = 68 N", "N", 17.5, force.thrust_N, Judged::difference, 0.2});
    figures.push_back({"Section 3.2: F, from the two printed components", "N", 68.0, std::hypot(65.6, 17.5),
                       Judged::difference, 0.5});
    result.checks.push_back(own_check("Section 3.2: τ_s times the section, which F = 68 N takes (neither is printed)",
                                      "N", resultant_N * edge.shear_stress_N_mm2 / orthogonal_resultant_N(edge, 1.0)));
}

/// F_x of the five cases over a revolution (Fig. 6).
void add_curves(Reproduction& result) {
    constexpr int points = 360;
    Plot all{
        "F_x of the five cases over one revolution (Fig. 6)",
        "rotation of the spindle in °",
        "F_x in N",
        "On the workpiece, along the feed; flank and bottom edge together. The scale follows from an assumed shear "
        "stress of 800 N/mm², which the paper does not print. In cuts 3 to 5 the teeth take turns and the force "
        "returns to nothing; in 1 and 2 the next tooth is there before.",
        {}};
    for (const Case& c : figure_6) {
        const FineCut cut = fine_cut(c);
        const CuttingForce plant = plant_of(cut, true);
        const EngagementMap map = map_of(cut);
        Series curve{c.name, Series::Style::line, {}, {}};
        for (int k = 0; k <= points; ++k) {
            curve.x.push_back(k);
            curve.y.push_back(plant.load(k * degree, feed_per_tooth_mm, map).fx_N);
        }
        all.series.push_back(curve);
    }
    result.plots.push_back(all);
}

/// F_x and F_z of case 4 by flank and by bottom edge.
void add_edges_apart(Reproduction& result) {
    const FineCut cut = fine_cut(figure_6[3]);
    const EngagementMap map = map_of(cut);
    const CuttingForce flank = plant_of(cut, false);
    const CuttingForce both = plant_of(cut, true);
    Plot parts{
        "Flank and bottom edge of case 4 (section 3)",
        "rotation of the spindle in °",
        "force in N",
        "a_p 1 mm, a_e 2 mm, up milling, one tooth pitch. The bottom edge cuts only while the tip is in the arc of "
        "cut, and presses the workpiece down; the flank's helix lifts it, and stays in cut until the top has left.",
        {{"flank, F_x", Series::Style::line, {}, {}},
         {"bottom edge, F_x", Series::Style::line, {}, {}},
         {"flank, F_z", Series::Style::line, {}, {}},
         {"bottom edge, F_z", Series::Style::line, {}, {}}}};
    for (int k = 0; k <= 180; ++k) {
        const double angle = 0.5 * k;
        const CuttingLoad one = flank.load(angle * degree, feed_per_tooth_mm, map);
        const CuttingLoad two = both.load(angle * degree, feed_per_tooth_mm, map);
        const std::array<double, 4> values{one.fx_N, two.fx_N - one.fx_N, one.fz_N, two.fz_N - one.fz_N};
        for (std::size_t j = 0; j < values.size(); ++j) {
            parts.series[j].x.push_back(angle);
            parts.series[j].y.push_back(values[j]);
        }
    }
    result.plots.push_back(parts);
}

/// What section 4 says about curve 4: low while only a part of the edge cuts, highest with all of it, 0 at last.
void add_shape_of_curve_4(Reproduction& result) {
    const FineCut cut = fine_cut(figure_6[3]);
    const CuttingForce plant = plant_of(cut, true);
    const EngagementMap map = map_of(cut);
    const double sweep_deg = cut.axial_depth_mm * std::tan(helix_rad) / radius_mm / degree;
    double peak_N = 0.0;
    double peak_at_deg = 0.0;
    for (int k = 0; k < 1800; ++k) {
        const double angle = 0.05 * k;
        const double force_N = std::abs(plant.load(angle * degree, feed_per_tooth_mm, map).fx_N);
        if (force_N > peak_N) {
            peak_N = force_N;
            peak_at_deg = angle;
        }
    }
    result.checks.push_back(
        own_check("Section 4, curve 4: the peak of F_x comes while the whole edge cuts (bound: from ψ_a to the exit)",
                  "°", peak_at_deg, Judged::within, cut.exit_rad / degree, sweep_deg));
    const double gone_deg = cut.exit_rad / degree + sweep_deg + 0.01;
    result.figures.push_back({fmt::format("Section 4, curve 4: F_x in the end; ours at {:.1f}° of 90°", gone_deg), "N",
                              0.0, plant.load(gone_deg * degree, feed_per_tooth_mm, map).fx_N, Judged::difference,
                              0.0});
}

void add_deviations(std::vector<std::string>& deviations) {
    deviations.emplace_back(
        "Chip thickness: |BC|² is printed as R² f_z² − 2 R f_z ∠BOC. The law of cosines has R² + f_z² − 2 R f_z cos "
        "∠BOC. The paper takes the axis to stand still between E and C; the plant solves for the true path.");
    deviations.emplace_back(
        "Eq. 1: the text calls θ_i the inclination of the cutting speed and i the angle of the shear plane. i is the "
        "inclination of the edge (the helix), θ_i that of the resultant out of the normal plane. The angles that the "
        "paper leaves open are closed by Stabler's rule.");
    deviations.emplace_back(
        "3.1.2 (3) and 3.1.3 (3), widths between r and 2r: at a_e 6 mm the printed signs give 78.5° of engagement in "
        "up milling, where it is 101.5°, and in climb milling an entry behind the exit. The formulas of case (1) "
        "hold for all widths; a_e 12 mm on Ø10, which none of the four cases covers, is a slot.");
    deviations.emplace_back(
        "3.1.2 (1)c: the upper limit is θ_ex − ψ_a, not θ_ex, in which ψ_a is already counted. The test between (1) "
        "and (2) must be made without ψ_a as well: as printed, (2) never occurs.");
    deviations.emplace_back(
        "3.1.3 (1)b is printed from π + ψ_a to θ_ex − ψ_a = π, an empty range: it begins at θ_st + ψ_a. 3.1.3 (2)b "
        "is integrated from π to π: the lower limit is θ_st. One rule replaces all cases: an element cuts while its "
        "own angle lies in [φ_st, φ_ex].");
    deviations.emplace_back(
        "Section 4 explains the fall of curve 4 by the chip growing thinner. It is the up-milling curve, whose chip "
        "grows until the exit: it falls because the edge leaves, from the tip up.");
    deviations.emplace_back(
        "The rake of the bottom edge is not printed: 5° is what the printed shear angle needs. With it the printed "
        "friction angle is Lee & Shaffer's 45° + γ − φ_c. F_x and F_z are printed from an F rounded to 68 N.");
    deviations.emplace_back(
        "τ_s, the friction and shear angles of the flank and the section of the bottom edge are not printed. Here: "
        "the bottom edge's angles for both, 800 N/mm², and a bottom edge as wide as gives 68 N at h = f_z. So the "
        "curves have the paper's shape, not its scale.");
}

constexpr const char* summary =
    "A model of the force on a flat end mill: what its helical flanks and its bottom edges cut, from the material's "
    "shear stress and the tool's angles. The simulation of this project mills with it, and tests its estimators "
    "against it. Here its force over a revolution is drawn for the paper's five cuts, the numbers that the paper "
    "prints are checked, and the simulated force is held against a far finer integration of the same model.";

std::vector<NotReproduced> not_reproduced() {
    return {
        {"Section 5: 7.38 %, the largest difference between model and measurement",
         "neither the measured force nor the shear stress τ_s is printed: it cannot be worked out, and no number here "
         "stands for it."},
        {"Figs. 6 and 7: the paper's curve and measured force",
         "the text that this project has holds no images. Fig. 6 is drawn from the plant, with an assumed τ_s."},
        {"Figs. 1–5", "sketches of edge, chip and angles: they show no data."},
    };
}

}  // namespace
}  // namespace guan_reproduction

Reproduction reproduce_guan() {
    using namespace guan_reproduction;
    Reproduction result;
    result.name = "guan";
    result.title = "The cutting force of a flat end mill, flank and bottom edge (Guan et al.)";
    result.source = {
        "Y. Guan, H. Guan, G. Wang, P. Yuan: The 3D Modeling of Cutting Force in High-speed Milling for Flat Mill. "
        "Institute of Advanced Engineering and Science, 2014. Volume and pages are not known here."};
    result.summary = summary;
    add_chisel_edge(result);
    add_curves(result);
    add_edges_apart(result);
    add_shape_of_curve_4(result);
    check_geometry(result);
    check_law_of_cosines(result);
    check_chip_models(result);
    check_integration(result);
    add_deviations(result.deviations);
    result.not_reproduced = not_reproduced();
    return result;
}

}  // namespace millforce::sim
