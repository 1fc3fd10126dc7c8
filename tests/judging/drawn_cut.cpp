// SPDX-License-Identifier: Apache-2.0
#include "judging/drawn_cut.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace millforce::judging {

namespace {

class Draw {
  public:
    explicit Draw(std::uint64_t seed) : random_(seed) {}
    double between(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    double normal(double mean, double sd) { return std::normal_distribution(mean, sd)(random_); }
    int below(int count) { return std::uniform_int_distribution(0, count - 1)(random_); }

  private:
    std::mt19937_64 random_;
};

TrueSpindle draw_spindle(const estimation::SpindleDriveParameters<float>& stated, Draw& draw) {
    const double K_t1 = static_cast<double>(stated.K_t1_Nm_per_A);
    const double idle_Nm = -static_cast<double>(stated.K_t2_Nm);
    const double warm_up_Nm = static_cast<double>(stated.warm_up_torque_Nm);
    return {
        .K_t1_Nm_per_A = draw.normal(K_t1, K_t1 * static_cast<double>(stated.gain_relative_sd)),
        .idle_torque_Nm = std::max(0.2, draw.normal(idle_Nm, static_cast<double>(stated.idle_torque_sd_Nm))),
        .warm_up_torque_Nm = std::max(0.0, draw.normal(warm_up_Nm, static_cast<double>(stated.warm_up_torque_sd_Nm))),
        .warm_up_time_s = static_cast<double>(stated.warm_up_time_s)};
}

TrueAxis draw_axis(const estimation::FeedDriveParameters<float>& stated, Draw& draw) {
    const double K_x4 = static_cast<double>(stated.K_x4_N_per_A);
    const double friction_sd = static_cast<double>(stated.friction_relative_sd);
    const double scale = draw.normal(1.0, friction_sd);
    return {.K_x4_N_per_A = draw.normal(K_x4, K_x4 * static_cast<double>(stated.gain_relative_sd)),
            .mass_kg = static_cast<double>(stated.mass_kg),
            .gravity_A = static_cast<double>(stated.gravity_A),
            .K_x3_A = static_cast<double>(stated.K_x3_A),
            .K_x2_A_min_per_m = {static_cast<double>(stated.negative.K_x2_A_min_per_m),
                                 static_cast<double>(stated.positive.K_x2_A_min_per_m)},
            .friction_scale = {std::max(0.4, scale), std::max(0.4, scale)},
            .ripple_A = static_cast<double>(stated.friction_ripple_A)};
}

/// A law with K_s and r_1 that do not depend on the chip, as a linear edge law has them; their doubts do.
TrueLaw draw_law(const estimation::CuttingLaw<float>& stated, Wrong wrong, Draw& draw) {
    const auto factor = [&draw](float relative_sd) {
        return std::exp(draw.normal(0.0, static_cast<double>(relative_sd)));
    };
    TrueLaw law{.reference_chip_mm = static_cast<double>(stated.reference_chip_thickness_mm),
                .K_s_N_per_mm2 = static_cast<double>(stated.k_s_N_per_mm2) * factor(stated.K_s_relative_sd),
                .K_s_exponent = draw.normal(0.0, static_cast<double>(stated.K_s_exponent_sd)),
                .r_1 = static_cast<double>(stated.k_1) * factor(stated.r_1_relative_sd),
                .r_1_exponent = draw.normal(0.0, static_cast<double>(stated.r_1_exponent_sd)),
                .K_te_N_per_mm = static_cast<double>(stated.K_te_N_per_mm),
                .K_re_N_per_mm = static_cast<double>(stated.K_re_N_per_mm)};
    if (wrong == Wrong::material) {
        constexpr double usual_chip_mm = 0.05;
        constexpr double exponent = -0.3;
        law.K_s_N_per_mm2 *= 2.0 * std::pow(law.reference_chip_mm / usual_chip_mm, exponent);
        law.K_s_exponent += exponent;
        law.r_1 *= 1.5;
    }
    return law;
}

/// With the feed at which the tooth's peak is a drawn share of its limit; one that is too small for a chip or too large
/// for a tool is drawn anew.
TrueCut draw_geometry(const firmware::ToolParameters<float>& stated, Wrong wrong, Draw& draw) {
    constexpr double smallest_feed_mm = 0.02;
    constexpr double largest_feed_mm = 0.14;
    const double limit_N = static_cast<double>(stated.tooth_force_limit_N);
    TrueCut cut{.law = draw_law(stated.law, wrong, draw),
                .teeth = stated.teeth,
                .radius_mm = 0.5 * static_cast<double>(stated.diameter_mm),
                .helix_rad = static_cast<double>(stated.helix_deg) * std::numbers::pi / 180.0,
                .eccentricity_mm = draw.between(0.0, 0.5e-3 * static_cast<double>(stated.runout_um)),
                .is_up = draw.below(2) == 1};
    do {
        cut.radial_immersion = draw.between(0.1, 2.0);
        cut.axial_depth_mm = draw.between(1.0, 0.7 * static_cast<double>(stated.flute_length_mm));
        cut.feed_per_tooth_mm =
            feed_per_tooth_at_limit_mm(cut, draw.between(0.2, 0.9) * limit_N, 2.0 * largest_feed_mm);
    } while (cut.feed_per_tooth_mm < smallest_feed_mm || cut.feed_per_tooth_mm > largest_feed_mm);
    return cut;
}

estimation::CutSide stated_side(const DrawnCut& drawn) {
    if (drawn.wrong == Wrong::nothing_stated) {
        return estimation::CutSide::unknown;
    }
    const bool shows_up = drawn.cut.is_up != (drawn.wrong == Wrong::side);
    return shows_up ? estimation::CutSide::up : estimation::CutSide::down;
}

}  // namespace

const char* name_of(Wrong wrong) {
    switch (wrong) {
        case Wrong::nothing:
            return "nothing";
        case Wrong::nothing_stated:
            return "nothing; side not stated";
        case Wrong::side:
            return "side";
        case Wrong::x_friction:
            return "x: 360 N of friction";
        case Wrong::x_reversed:
            return "x: reversed";
        case Wrong::x_dead:
            return "x: dead";
        case Wrong::x_tenfold:
            return "x: tenfold";
        case Wrong::axes_swapped:
            return "x and y swapped";
        case Wrong::spindle_weak:
            return "spindle: × 0.3";
        case Wrong::spindle_frozen:
            return "spindle: frozen";
        case Wrong::spindle_saturated:
            return "spindle: saturated";
        case Wrong::edge_forces:
            return "edge forces";
        case Wrong::material:
            return "material";
    }
    return "";
}

DrawnCut draw_cut(const firmware::Parameters<float>& files, Wrong wrong, std::uint64_t seed) {
    constexpr std::array noise_of_rated{0.003, 0.01, 0.03};
    constexpr int directions = 8;
    Draw draw(seed);
    DrawnCut drawn;
    drawn.wrong = wrong;
    drawn.seed = seed;
    drawn.stated = files;
    drawn.spindle = draw_spindle(files.machine.spindle, draw);
    for (std::size_t axis = 0; axis < drawn.axes.size(); ++axis) {
        drawn.axes[axis] = draw_axis(files.machine.axes[axis], draw);
    }
    drawn.direction_rad = draw.below(directions) * std::numbers::pi / 4.0;
    drawn.turns_per_s = draw.between(10.0, 100.0);
    const double rated_A = static_cast<double>(files.machine.spindle_rated_current_A);
    drawn.noise_A = noise_of_rated[static_cast<std::size_t>(draw.below(noise_of_rated.size()))] * rated_A;
    drawn.cut = draw_geometry(files.tool, wrong, draw);

    drawn.stated.machine.spindle.current_sd_A = static_cast<float>(drawn.noise_A);
    for (auto& axis : drawn.stated.machine.axes) {
        axis.current_sd_A = static_cast<float>(drawn.noise_A);
    }
    drawn.stated.tool.side = stated_side(drawn);
    if (wrong == Wrong::edge_forces) {
        drawn.stated.tool.law.K_te_N_per_mm = 0.0F;
        drawn.stated.tool.law.K_re_N_per_mm = 0.0F;
    }
    return drawn;
}

}  // namespace millforce::judging
