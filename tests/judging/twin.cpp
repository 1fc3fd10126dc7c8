// SPDX-License-Identifier: Apache-2.0
#include "judging/twin.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace millforce::judging {

namespace {

constexpr double misfit_of_the_right_model = 3.84;  // in 95 of 100
constexpr double inside_mm = -1e9;                  // the workpiece is all around
constexpr double smallest_engagement_rad = 0.3;
constexpr int arcs = 48;
constexpr int between_arcs = 8;
constexpr std::size_t air_begins = 60;  // samples after the rapid: the axes have slowed down
constexpr std::size_t air_ends = 330;   // and the tool is not in contact yet

bool is_moving(double share) {
    constexpr double at_rest = 1e-6;
    return std::abs(share) > at_rest;
}

TrueCut cut_of_the_files(const DrawnCut& drawn) {
    const estimation::CuttingLaw<float>& law = drawn.stated.tool.law;
    TrueCut cut = drawn.cut;
    cut.law = {.reference_chip_mm = static_cast<double>(law.reference_chip_thickness_mm),
               .K_s_N_per_mm2 = static_cast<double>(law.k_s_N_per_mm2),
               .K_s_exponent = 0.0,
               .r_1 = static_cast<double>(law.k_1),
               .r_1_exponent = 0.0,
               .K_te_N_per_mm = static_cast<double>(law.K_te_N_per_mm),
               .K_re_N_per_mm = static_cast<double>(law.K_re_N_per_mm)};
    return cut;
}

/// At a usual chip; the exponent counts from the reference chip on.
double r_1_doubt(const estimation::CuttingLaw<float>& law, double feed_per_tooth_mm) {
    constexpr double usual_share = 0.6;
    const double chip_mm = usual_share * feed_per_tooth_mm;
    const double by_exponent = static_cast<double>(law.r_1_exponent_sd) *
                               std::log(chip_mm / static_cast<double>(law.reference_chip_thickness_mm));
    return std::hypot(static_cast<double>(law.r_1_relative_sd), by_exponent);
}

}  // namespace

double allowed_override(const TrueCut& cut, const DrawnCut& drawn) {
    constexpr double most_mm = 1.0;
    constexpr double tolerated_share = 1.05;
    const double tolerated_N = tolerated_share * static_cast<double>(drawn.stated.tool.tooth_force_limit_N);
    return drawn.override * feed_per_tooth_at_limit_mm(cut, tolerated_N, most_mm) / drawn.cut.feed_per_tooth_mm;
}

TwinSearch::TwinSearch(const DrawnCut& seen, const Recording& recording)
    : seen_(seen),
      recording_(recording),
      stated_(cut_of_the_files(seen)),
      r_1_relative_sd_(r_1_doubt(seen.stated.tool.law, seen.cut.feed_per_tooth_mm)),
      moves_{is_moving(std::cos(seen.direction_rad)), is_moving(std::sin(seen.direction_rad))} {
    const firmware::MachineParameters<float>& machine = seen.stated.machine;
    N_per_A_ = {1000.0 * static_cast<double>(machine.spindle.K_t1_Nm_per_A) / seen.cut.radius_mm,
                static_cast<double>(machine.axes[0].K_x4_N_per_A), static_cast<double>(machine.axes[1].K_x4_N_per_A)};
    air_A_ = mean_A(recording.rapid_end + air_begins, recording.rapid_end + air_ends);
    if (!air_is_right()) {
        return;
    }
    nodes_.reserve(std::size_t{2} * (arcs + 1));
    for (const bool is_up : {false, true}) {
        for (int arc = 0; arc <= arcs; ++arc) {
            const double range_rad = std::numbers::pi - smallest_engagement_rad;
            nodes_.push_back(node_at(is_up, smallest_engagement_rad + range_rad * arc / arcs));
        }
    }
}

TwinSearch::Signals TwinSearch::mean_A(std::size_t from, std::size_t to) const {
    Signals sum{};
    for (std::size_t i = from; i < to; ++i) {
        const hal::DriveSample& s = recording_.samples[i];
        sum[spindle] += static_cast<double>(s.spindle_current_A);
        sum[1] += static_cast<double>(s.axis_current_A[0]);
        sum[2] += static_cast<double>(s.axis_current_A[1]);
    }
    for (double& value : sum) {
        value /= static_cast<double>(to - from);
    }
    return sum;
}

bool TwinSearch::air_is_right() const {
    constexpr double deviations = 3.0;
    const firmware::MachineParameters<float>& machine = seen_.stated.machine;
    const auto& drive = machine.spindle;
    const double idle_Nm = static_cast<double>(drive.warm_up_torque_Nm - drive.K_t2_Nm);
    const double idle_sd_Nm = static_cast<double>(std::hypot(drive.idle_torque_sd_Nm, drive.warm_up_torque_sd_Nm));
    const double shown_Nm = static_cast<double>(drive.K_t1_Nm_per_A) * air_A_[spindle];
    bool is_right = std::abs(shown_Nm - idle_Nm) < deviations * idle_sd_Nm;
    const std::array<double, 2> shares{std::cos(seen_.direction_rad), std::sin(seen_.direction_rad)};
    for (std::size_t k = 0; k < moves_.size(); ++k) {
        const auto& axis = machine.axes[k];
        const double feed_mm_s = seen_.cut.feed_per_tooth_mm * seen_.cut.teeth * seen_.turns_per_s;
        const double w_m_per_min = 0.06 * feed_mm_s * std::abs(shares[k]);
        const auto& direction = shares[k] > 0.0 ? axis.positive : axis.negative;
        const double friction_A =
            static_cast<double>(axis.K_x3_A) + static_cast<double>(direction.K_x2_A_min_per_m) * w_m_per_min;
        const double shown_A = (air_A_[1 + k] - static_cast<double>(axis.gravity_A)) * (shares[k] > 0.0 ? 1.0 : -1.0);
        const double off_A = std::abs(shown_A - friction_A);
        is_right = is_right &&
                   (!moves_[k] || off_A < deviations * static_cast<double>(axis.friction_relative_sd) * friction_A);
    }
    return is_right;
}

/// Of a revolution: F_at, and the forces on the workpiece along x and y.
TwinSearch::Signals TwinSearch::mean_force_N(const TrueCut& cut) const {
    constexpr int angles = 48;
    const double t_x = std::cos(seen_.direction_rad);
    const double t_y = std::sin(seen_.direction_rad);
    Signals mean{};
    for (int i = 0; i < angles; ++i) {
        const double angle_rad = 2.0 * std::numbers::pi * i / angles;
        const MomentaryForce force = momentary_force(cut, angle_rad, inside_mm);
        mean[spindle] += 1000.0 * force.torque_Nm / cut.radius_mm / angles;
        mean[1] += (force.feed_N * t_x - force.left_N * t_y) / angles;
        mean[2] += (force.feed_N * t_y + force.left_N * t_x) / angles;
    }
    return mean;
}

/// Averages are proportional to the depth. A thin cut's edges are spread over the step from one angle to the next.
TwinSearch::Node TwinSearch::node_at(bool is_up, double engagement_rad) const {
    TrueCut cut = stated_;
    cut.is_up = is_up;
    cut.radial_immersion = 1.0 - std::cos(engagement_rad);
    cut.axial_depth_mm = 1.0;
    Node node{.is_up = is_up, .radial_immersion = cut.radial_immersion, .force_N = mean_force_N(cut), .by_r_1_N{}};
    cut.law.r_1 *= 1.0 + r_1_relative_sd_;
    node.by_r_1_N = mean_force_N(cut);
    for (std::size_t k = 0; k < signals; ++k) {
        node.by_r_1_N[k] -= node.force_N[k];
    }
    return node;
}

/// The depth that shows most nearly the same.
Twin TwinSearch::twin_of(const Node& node, const Signals& seen_N, const Signals& noise_N) const {
    constexpr int improvements = 3;
    constexpr double break_away = 1.3;  // over the friction of a sliding axis
    constexpr double not_seen_N = 1e6;  // the noise of what an axis at rest shows
    const firmware::MachineParameters<float>& machine = seen_.stated.machine;
    const Signals gain_sd{static_cast<double>(machine.spindle.gain_relative_sd),
                          static_cast<double>(machine.axes[0].gain_relative_sd),
                          static_cast<double>(machine.axes[1].gain_relative_sd)};
    const Eigen::Map<const Eigen::Vector3d> force(node.force_N.data());
    const Eigen::Map<const Eigen::Vector3d> by_r_1(node.by_r_1_N.data());
    const Eigen::Map<const Eigen::Vector3d> seen(seen_N.data());
    double depth_mm = std::max(0.0, seen_N[spindle] / node.force_N[spindle]);
    double misfit = 0.0;
    for (int i = 0; i < improvements; ++i) {
        Eigen::Matrix3d covariance = by_r_1 * by_r_1.transpose() * depth_mm * depth_mm;
        for (std::size_t k = 0; k < signals; ++k) {
            const bool is_seen = k == spindle || moves_[k - 1];
            const double sd_N = is_seen ? std::hypot(noise_N[k], gain_sd[k] * node.force_N[k] * depth_mm) : not_seen_N;
            const auto at = static_cast<Eigen::Index>(k);
            covariance(at, at) += sd_N * sd_N;
        }
        const Eigen::Matrix3d weight = covariance.inverse();
        depth_mm = force.dot(weight * seen) / force.dot(weight * force);
        const Eigen::Vector3d off = seen - force * depth_mm;
        misfit = off.dot(weight * off);
    }
    for (std::size_t k = 0; k < moves_.size(); ++k) {
        const auto& axis = machine.axes[k];
        const double held_N = break_away * static_cast<double>(axis.K_x4_N_per_A * axis.K_x3_A) *
                              (1.0 + 2.0 * static_cast<double>(axis.friction_relative_sd));
        const double beyond_N = std::abs(seen_N[1 + k] - node.force_N[1 + k] * depth_mm) - held_N;
        misfit += !moves_[k] && beyond_N > 0.0 ? std::pow(beyond_N / noise_N[1 + k], 2) : 0.0;
    }
    Twin twin{.cut = stated_, .misfit = misfit};
    twin.cut.is_up = node.is_up;
    twin.cut.radial_immersion = node.radial_immersion;
    twin.cut.axial_depth_mm = depth_mm;
    return twin;
}

std::vector<Twin> TwinSearch::twins_at(std::size_t sample) const {
    constexpr double least_samples = 12.0;
    constexpr double windows = 8.0;
    const double samples_per_turn = 1000.0 / seen_.turns_per_s;
    const double window = std::ceil(least_samples / samples_per_turn) * samples_per_turn;
    const auto known = sample - recording_.whole_from;
    const std::size_t count = std::min(known, static_cast<std::size_t>(std::lround(windows * window)));
    if (nodes_.empty() || count == 0) {
        return {};
    }
    Signals seen_N = mean_A(sample - count, sample);
    Signals noise_N{};
    const double noise_A = seen_.noise_A * std::sqrt(1.0 / static_cast<double>(count) + 1.0 / (air_ends - air_begins));
    for (std::size_t k = 0; k < signals; ++k) {
        const double ripple_A =
            k == spindle ? 0.0 : static_cast<double>(seen_.stated.machine.axes[k - 1].friction_ripple_A);
        seen_N[k] = (seen_N[k] - air_A_[k]) * N_per_A_[k];
        noise_N[k] = std::hypot(noise_A, ripple_A) * N_per_A_[k];
    }
    const double flute_mm = static_cast<double>(seen_.stated.tool.flute_length_mm);
    std::vector<Twin> twins;
    for (std::size_t n = 0; n + 1 < nodes_.size(); ++n) {
        if (nodes_[n].is_up != nodes_[n + 1].is_up) {
            continue;
        }
        for (int step = 0; step < between_arcs; ++step) {
            const double share = static_cast<double>(step) / between_arcs;
            Node node = nodes_[n];
            const Node& next = nodes_[n + 1];
            node.radial_immersion += share * (next.radial_immersion - node.radial_immersion);
            for (std::size_t k = 0; k < signals; ++k) {
                node.force_N[k] += share * (next.force_N[k] - node.force_N[k]);
                node.by_r_1_N[k] += share * (next.by_r_1_N[k] - node.by_r_1_N[k]);
            }
            const Twin twin = twin_of(node, seen_N, noise_N);
            const bool is_within = twin.cut.axial_depth_mm > 0.0 && twin.cut.axial_depth_mm < flute_mm;
            if (is_within && twin.misfit < misfit_of_the_right_model) {
                twins.push_back(twin);
            }
        }
    }
    return twins;
}

}  // namespace millforce::judging
