// SPDX-License-Identifier: Apache-2.0
#include "machine/drive_plant.hpp"

#include <algorithm>
#include <cmath>

#include "cutting/angle_units.hpp"

namespace millforce::sim {

namespace {

constexpr double current_limit_of_rated = 2.5;

double first_order(double value, double target, double dt_s, double time_constant_s) {
    return value + (target - value) * (1.0 - std::exp(-dt_s / time_constant_s));
}

}  // namespace

double SpindlePlant::torque_constant(double speed_rad_s) const {
    const double weakening = std::max(1.0, std::abs(speed_rad_s) / settings_.base_speed_rad_s);
    return settings_.torque_constant_Nm_per_A / weakening;
}

double SpindlePlant::idle_torque_Nm(double speed_rad_s) const {
    const double warmth = 1.0 + settings_.cold_excess * std::exp(-time_s_ / settings_.warm_up_time_s);
    const double magnitude = settings_.bearing_torque_Nm + settings_.bearing_viscous_Nm_s * std::abs(speed_rad_s);
    return std::copysign(magnitude * warmth * settings_.friction_scale, speed_rad_s);
}

void SpindlePlant::start_at(double speed_rad_s) {
    speed_rad_s_ = speed_rad_s;
    integral_A_ = speed_rad_s != 0.0 ? idle_torque_Nm(speed_rad_s) / torque_constant(speed_rad_s) : 0.0;
    current_A_ = integral_A_;
}

void SpindlePlant::advance(double dt_s, double commanded_speed_rad_s, double cutting_torque_Nm) {
    const double loop_rad_s = sim::turn * settings_.speed_loop_bandwidth_hz;
    const double constant = torque_constant(speed_rad_s_);
    const double gain_A_s = settings_.inertia_kg_m2 * loop_rad_s / constant;
    const double error = commanded_speed_rad_s - speed_rad_s_;
    const double limit_A = settings_.largest_current_of_rated * settings_.rated_current_A;
    const double wanted_A = gain_A_s * error + integral_A_;
    if (std::abs(wanted_A) < limit_A) {
        integral_A_ += gain_A_s * loop_rad_s / 4.0 * error * dt_s;
    }
    current_A_ = first_order(current_A_, std::clamp(wanted_A, -limit_A, limit_A), dt_s, settings_.current_loop_time_s);
    turn(dt_s, constant * current_A_ - cutting_torque_Nm);
    angle_rad_ += speed_rad_s_ * dt_s;
    time_s_ += dt_s;
}

// Dry friction brings the spindle to rest and holds it there; it never turns it.
void SpindlePlant::turn(double dt_s, double torque_Nm) {
    if (speed_rad_s_ == 0.0) {
        const double holding_Nm = idle_torque_Nm(0.0);
        const double excess_Nm = std::max(0.0, std::abs(torque_Nm) - holding_Nm);
        speed_rad_s_ = std::copysign(excess_Nm, torque_Nm) / settings_.inertia_kg_m2 * dt_s;
        return;
    }
    const double before_rad_s = speed_rad_s_;
    speed_rad_s_ += (torque_Nm - idle_torque_Nm(speed_rad_s_)) / settings_.inertia_kg_m2 * dt_s;
    if (before_rad_s * speed_rad_s_ < 0.0) {
        speed_rad_s_ = 0.0;
    }
}

void FeedPlant::start_at(double position_mm) {
    position_mm_ = position_mm;
    velocity_mm_s_ = 0.0;
    integral_A_ = settings_.weight_N / settings_.force_constant_N_per_A;
    current_A_ = integral_A_;
}

// Dahl's bristle with Stribeck's curve, its state advanced implicitly: stable at any step.
double FeedPlant::friction_force_N(double dt_s) {
    const bool forward = velocity_mm_s_ >= 0.0;
    const double ripple = 1.0 + settings_.ripple_share * std::sin(sim::turn * position_mm_ / settings_.screw_pitch_mm);
    const double coulomb_N = (forward ? settings_.coulomb_positive_N : settings_.coulomb_negative_N) * ripple;
    const double stribeck = std::exp(-std::pow(velocity_mm_s_ / settings_.stribeck_velocity_mm_s, 2.0));
    const double level_N = std::max(1e-6, coulomb_N * (1.0 + settings_.stribeck_excess * stribeck));
    const double before_mm = presliding_mm_;
    presliding_mm_ = (presliding_mm_ + velocity_mm_s_ * dt_s) /
                     (1.0 + std::abs(velocity_mm_s_) * dt_s * settings_.presliding_stiffness_N_per_mm / level_N);
    const double rate_mm_s = (presliding_mm_ - before_mm) / dt_s;
    const double viscous = forward ? settings_.viscous_positive_N_s_per_mm : settings_.viscous_negative_N_s_per_mm;
    return settings_.friction_scale * (settings_.presliding_stiffness_N_per_mm * presliding_mm_ +
                                       settings_.presliding_damping_N_s_per_mm * rate_mm_s + viscous * velocity_mm_s_);
}

void FeedPlant::advance(double dt_s, double commanded_position_mm, double commanded_velocity_mm_s,
                        double cutting_force_N) {
    const double loop_rad_s = sim::turn * settings_.velocity_loop_bandwidth_hz;
    const double kg_per_A = settings_.mass_kg * 1e-3 / settings_.force_constant_N_per_A;  // mm/s² of N per kg: 1e3
    const double wanted_mm_s =
        commanded_velocity_mm_s + settings_.position_gain_per_s * (commanded_position_mm - position_mm_);
    const double error_mm_s = wanted_mm_s - velocity_mm_s_;
    const double gain = kg_per_A * loop_rad_s;
    const double limit_A = current_limit_of_rated * settings_.rated_current_A;
    const double wanted_A = gain * error_mm_s + integral_A_;
    if (std::abs(wanted_A) < limit_A) {
        integral_A_ += gain * loop_rad_s / 4.0 * error_mm_s * dt_s;
    }
    current_A_ = first_order(current_A_, std::clamp(wanted_A, -limit_A, limit_A), dt_s, settings_.current_loop_time_s);
    const double force_N =
        settings_.force_constant_N_per_A * current_A_ - friction_force_N(dt_s) - cutting_force_N - settings_.weight_N;
    velocity_mm_s_ += force_N / settings_.mass_kg * 1e3 * dt_s;
    position_mm_ += velocity_mm_s_ * dt_s;
}

double CurrentSensor::read(double current_A) {
    const double noisy_A = current_A + noise_A_ * normal_(random_);
    switch (channel_) {
        case CurrentChannel::exact:
            return noisy_A;
        case CurrentChannel::per_mille_int16:
            return std::clamp(std::round(noisy_A / rated_A_ * 1000.0), -32768.0, 32767.0) * rated_A_ / 1000.0;
        case CurrentChannel::adc_12_bit: {
            const double step_A = 2.0 * current_limit_of_rated * rated_A_ / 4096.0;
            return std::clamp(std::round(noisy_A / step_A), -2048.0, 2047.0) * step_A;
        }
    }
    return noisy_A;
}

void EncoderSensor::update(double angle_rad) {
    const double turns = angle_rad / sim::turn;
    const double offset_turns = index_offset_rad_ / sim::turn;
    const auto whole_count = static_cast<std::int64_t>(std::floor(turns * counts_per_rev_));
    count_ = static_cast<std::uint32_t>(whole_count);
    const auto whole_turn = static_cast<std::int64_t>(std::floor(turns - offset_turns));
    if (started_ && whole_turn != last_turn_) {
        const double at_index =
            (static_cast<double>(std::max(whole_turn, last_turn_)) + offset_turns) * counts_per_rev_;
        index_count_ = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(at_index)));
        ++index_number_;
        if (index_number_ == 0) {
            index_number_ = 1;  // 0 means that no index is wired
        }
    }
    last_turn_ = whole_turn;
    started_ = true;
}

}  // namespace millforce::sim
