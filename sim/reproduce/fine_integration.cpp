// SPDX-License-Identifier: Apache-2.0
#include "reproduce/fine_integration.hpp"

#include "cutting/angle_units.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace millforce::sim {
namespace brute_force {
namespace {

using Eigen::Vector3d;

/// Force on the workpiece per mm² of chip section (width along `across` × thickness): `velocity` of the edge, `out` of
/// the workpiece towards the chip, both unit vectors; the edge is inclined by `inclination` against `across`, trailing.
Vector3d pressure_of(const ShearedEdge& edge, double inclination, const Vector3d& velocity, const Vector3d& out,
                     const Vector3d& across) {
    const Vector3d along_edge = std::cos(inclination) * across - std::sin(inclination) * velocity;
    const Vector3d forward = std::cos(inclination) * velocity + std::sin(inclination) * across;
    const Vector3d up_the_face = std::cos(edge.rake_rad) * out - std::sin(edge.rake_rad) * forward;
    const Vector3d face_normal = std::cos(edge.rake_rad) * forward + std::sin(edge.rake_rad) * out;
    const Vector3d flow = std::cos(inclination) * up_the_face + std::sin(inclination) * along_edge;
    const Vector3d per_normal_force = face_normal - std::tan(edge.friction_angle_rad) * flow;
    const Vector3d shear_normal = std::sin(edge.shear_angle_rad) * forward - std::cos(edge.shear_angle_rad) * out;
    const double in_shear_plane = (per_normal_force - per_normal_force.dot(shear_normal) * shear_normal).norm();
    const double sheared_area_per_section = 1.0 / (std::cos(inclination) * std::sin(edge.shear_angle_rad));
    return per_normal_force * (edge.shear_stress_N_mm2 * sheared_area_per_section / in_shear_plane);
}

Vector3d outward(double phi) {
    return {std::sin(phi), std::cos(phi), 0.0};
}
Vector3d motion(double phi) {
    return {std::cos(phi), -std::sin(phi), 0.0};
}

/// Flank: the chip peels inwards, off the wall that is left outside.
Vector3d flank_force_N(const FineCut& cut, double phi, double width_mm) {
    const double section_mm2 = fine_chip_mm(cut, phi) * width_mm;
    return section_mm2 * pressure_of(cut.flank, cut.helix_rad, motion(phi), -outward(phi), Vector3d::UnitZ());
}

/// Bottom: the edge lies along the radius, the chip rises off the floor.
Vector3d bottom_force_N(const FineCut& cut, double phi) {
    const double section_mm2 = fine_chip_mm(cut, phi) * cut.bottom_width_mm;
    return section_mm2 * pressure_of(cut.bottom, 0.0, motion(phi), Vector3d::UnitZ(), outward(phi));
}

void add(FineForce& total, const Vector3d& force_N, double phi, double arm_mm) {
    total.fx_N += force_N.x();
    total.fy_N += force_N.y();
    total.fz_N += force_N.z();
    total.torque_Nm += 1e-3 * arm_mm * force_N.dot(motion(phi));
}

/// One tooth with its tip at `tip`.
void add_tooth(const FineCut& cut, double tip, int axial_steps, FineForce& total) {
    const double lag_per_mm = std::tan(cut.helix_rad) / cut.radius_mm;
    double low_mm = 0.0;
    double high_mm = cut.axial_depth_mm;
    if (lag_per_mm > 0.0) {
        low_mm = std::max(low_mm, (tip - cut.exit_rad) / lag_per_mm);
        high_mm = std::min(high_mm, (tip - cut.entry_rad) / lag_per_mm);
    } else if (tip < cut.entry_rad || tip > cut.exit_rad) {
        return;
    }
    const double step_mm = (high_mm - low_mm) / axial_steps;
    for (int k = 0; k < axial_steps && step_mm > 0.0; ++k) {
        const double phi = tip - lag_per_mm * (low_mm + (k + 0.5) * step_mm);
        add(total, flank_force_N(cut, phi, step_mm), phi, cut.radius_mm);
    }
    if (cut.bottom_width_mm > 0.0 && tip >= cut.entry_rad && tip <= cut.exit_rad) {
        add(total, bottom_force_N(cut, tip), tip, cut.radius_mm - 0.5 * cut.bottom_width_mm);
    }
}

/// Angles in [0, pitch] at which a tip or the top of an edge enters or leaves.
std::vector<double> events_in_pitch(const FineCut& cut) {
    const double pitch = turn / cut.teeth;
    const double sweep = cut.axial_depth_mm * std::tan(cut.helix_rad) / cut.radius_mm;
    std::vector<double> events{0.0, pitch};
    for (const double angle : {cut.entry_rad, cut.exit_rad, cut.entry_rad + sweep, cut.exit_rad + sweep}) {
        events.push_back(angle - pitch * std::floor(angle / pitch));
    }
    std::sort(events.begin(), events.end());
    return events;
}

}  // namespace
}  // namespace brute_force

double fine_chip_mm(const FineCut& cut, double phi_rad) {
    const double pitch = turn / cut.teeth;
    const double R = cut.radius_mm;
    const double advance_per_rad = cut.feed_per_tooth_mm / pitch;
    // Position of the previous tooth, in the frame of the present axis, when it was at `angle`.
    const auto earlier = [&](double angle) {
        const double turned_since = pitch + phi_rad - angle;
        return Eigen::Vector2d(R * std::sin(angle) - advance_per_rad * turned_since, R * std::cos(angle));
    };
    double low = phi_rad - 0.7;
    double high = phi_rad + 0.7;
    constexpr int halvings = 44;
    for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (low + high);
        const Eigen::Vector2d point = earlier(middle);
        const double ahead_of_ray = point.x() * std::cos(phi_rad) - point.y() * std::sin(phi_rad);
        (ahead_of_ray < 0.0 ? low : high) = middle;
    }
    return std::max(0.0, R - earlier(0.5 * (low + high)).norm());
}

FineForce fine_force(const FineCut& cut, double spindle_angle_rad, int axial_steps) {
    using namespace brute_force;
    const double pitch = turn / cut.teeth;
    FineForce total;
    for (int tooth = 0; tooth < cut.teeth; ++tooth) {
        const double behind = spindle_angle_rad - tooth * pitch;
        const double tip = behind - turn * std::floor(behind / turn);
        add_tooth(cut, tip, axial_steps, total);
        add_tooth(cut, tip + turn, axial_steps, total);  // the tip is through its turn, the edge above still cuts
    }
    return total;
}

FineForce fine_average(const FineCut& cut, int angle_steps, int axial_steps) {
    const double pitch = turn / cut.teeth;
    const std::vector<double> events = brute_force::events_in_pitch(cut);
    FineForce mean;
    for (std::size_t part = 0; part + 1 < events.size(); ++part) {
        const double step = (events[part + 1] - events[part]) / angle_steps;
        for (int k = 0; k < angle_steps && step > 0.0; ++k) {
            const FineForce force = fine_force(cut, events[part] + (k + 0.5) * step, axial_steps);
            mean.fx_N += force.fx_N * step / pitch;
            mean.fy_N += force.fy_N * step / pitch;
            mean.fz_N += force.fz_N * step / pitch;
            mean.torque_Nm += force.torque_Nm * step / pitch;
        }
    }
    return mean;
}

double fine_shear_angle_rad(double rake_rad, double compression) {
    double low = 1e-6;
    double high = 0.5 * std::numbers::pi;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        // The shear plane is as long for the uncut thickness as for the chip: h_D/sin φ = h_ch/cos(φ − γ).
        (std::cos(middle - rake_rad) > compression * std::sin(middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace millforce::sim
