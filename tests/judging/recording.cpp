// SPDX-License-Identifier: Apache-2.0
#include "judging/recording.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace millforce::judging {

namespace {

constexpr double sample_s = 0.001;
constexpr int steps_per_sample = 4;
constexpr double step_s = sample_s / steps_per_sample;
constexpr double rapid_mm_s = 100.0;
constexpr double rapid_s = 0.8;
constexpr double air_s = 0.3;
constexpr double drive_bandwidth_hz = 100.0;
constexpr double acceleration_mm_s2 = 2000.0;
constexpr double full_turn = 2.0 * std::numbers::pi;

/// What the axis does not follow at once: torque and forces behind a drive's lag.
struct Lagged {
    double torque_Nm = 0.0;
    double x_N = 0.0;
    double y_N = 0.0;

    void follow(double torque, double x, double y) {
        const double share = 1.0 - std::exp(-full_turn * drive_bandwidth_hz * step_s);
        torque_Nm += share * (torque - torque_Nm);
        x_N += share * (x - x_N);
        y_N += share * (y - y_N);
    }
};

class Recorder {
  public:
    explicit Recorder(const DrawnCut& drawn)
        : drawn_(drawn),
          random_(drawn.seed ^ 0x9E3779B97F4A7C15U),
          feed_mm_s_(drawn.cut.feed_per_tooth_mm * drawn.cut.teeth * drawn.turns_per_s) {}

    Recording make() {
        Recording recording;
        recording.program.programmed_feed_mm_s = static_cast<float>(feed_mm_s_ / drawn_.override);
        while (time_s_ < rapid_s) {
            recording.samples.push_back(sample(rapid_mm_s));
        }
        recording.rapid_end = recording.samples.size();
        const double ramp_mm = (rapid_mm_s * rapid_mm_s - feed_mm_s_ * feed_mm_s_) / (2.0 * acceleration_mm_s2);
        face_mm_ = position_mm_ + ramp_mm + feed_mm_s_ * air_s + drawn_.cut.radius_mm;
        while (ahead_mm() > 0.0) {
            recording.samples.push_back(sample(feed_mm_s_));
        }
        recording.whole_from = recording.samples.size();
        const double steady_s = std::max(1.5, 25.0 / drawn_.turns_per_s);
        const auto end = recording.samples.size() + static_cast<std::size_t>(steady_s / sample_s);
        while (recording.samples.size() < end) {
            recording.samples.push_back(sample(feed_mm_s_));
        }
        return recording;
    }

  private:
    [[nodiscard]] double ahead_mm() const { return face_mm_ - position_mm_; }
    [[nodiscard]] bool has_contact() const { return ahead_mm() < drawn_.cut.radius_mm; }

    hal::DriveSample sample(double wanted_mm_s) {
        const double before_mm_s = speed_mm_s_;
        for (int step = 0; step < steps_per_sample; ++step) {
            const double change = acceleration_mm_s2 * step_s;
            speed_mm_s_ += std::clamp(wanted_mm_s - speed_mm_s_, -change, change);
            position_mm_ += speed_mm_s_ * step_s;
            time_s_ += step_s;
            follow_forces();
        }
        const double acceleration = (speed_mm_s_ - before_mm_s) / sample_s;
        hal::DriveSample s;
        s.present = hal::all_present;
        s.time_us = static_cast<std::uint32_t>(std::lround(time_s_ * 1e6));
        put_encoder(s);
        put_spindle(s);
        const double cosine = std::cos(drawn_.direction_rad);
        const double sine = std::sin(drawn_.direction_rad);
        s.axis_velocity_mm_s = {static_cast<float>(speed_mm_s_ * cosine), static_cast<float>(speed_mm_s_ * sine), 0.0F};
        s.axis_current_A = {axis_current_A(0, cosine, acceleration, lagged_.x_N),
                            axis_current_A(1, sine, acceleration, lagged_.y_N), 0.0F};
        show_wrong_axes(s);
        return s;
    }

    void follow_forces() {
        MomentaryForce force;
        if (has_contact()) {
            force = momentary_force(drawn_.cut, full_turn * drawn_.turns_per_s * time_s_, ahead_mm());
        }
        const double t_x = std::cos(drawn_.direction_rad);
        const double t_y = std::sin(drawn_.direction_rad);
        lagged_.follow(force.torque_Nm, force.feed_N * t_x - force.left_N * t_y,
                       force.feed_N * t_y + force.left_N * t_x);
    }

    void put_encoder(hal::DriveSample& s) const {
        const double counts = drawn_.stated.machine.encoder_counts_per_rev;
        const double turns = drawn_.turns_per_s * time_s_;
        s.spindle_count = static_cast<std::uint32_t>(turns * counts);
        s.spindle_index_count = static_cast<std::uint32_t>(std::floor(turns) * counts);
        s.spindle_index_number = static_cast<std::uint8_t>(static_cast<std::uint32_t>(turns) % 256U);
    }

    void put_spindle(hal::DriveSample& s) {
        const TrueSpindle& spindle = drawn_.spindle;
        const double idle_Nm =
            spindle.idle_torque_Nm + spindle.warm_up_torque_Nm * std::exp(-time_s_ / spindle.warm_up_time_s);
        const double idle_A = idle_Nm / spindle.K_t1_Nm_per_A;
        double current_A = idle_A + lagged_.torque_Nm / spindle.K_t1_Nm_per_A;
        if (drawn_.wrong == Wrong::spindle_saturated) {
            current_A = std::min(current_A, 1.5 * idle_A);
        }
        current_A += noise_A();
        if (drawn_.wrong == Wrong::spindle_weak) {
            current_A *= 0.3;
        }
        if (drawn_.wrong == Wrong::spindle_frozen && has_contact()) {
            current_A = frozen_A_;
        }
        frozen_A_ = current_A;
        s.spindle_current_A = static_cast<float>(current_A);
    }

    float axis_current_A(std::size_t index, double share_of_travel, double acceleration_mm_s2_along, double force_N) {
        const TrueAxis& axis = drawn_.axes[index];
        const double w_m_per_min = std::abs(speed_mm_s_ * share_of_travel) * 0.06;
        const bool is_moving = w_m_per_min > 1e-6;
        const std::size_t direction = share_of_travel > 0.0 ? 1 : 0;
        const double sign = share_of_travel > 0.0 ? 1.0 : -1.0;
        double friction_A = 0.0;
        if (is_moving) {
            const double ripple_A = axis.ripple_A * std::numbers::sqrt2 * std::sin(full_turn * position_mm_ / 10.0);
            friction_A =
                sign * axis.friction_scale[direction] * (axis.K_x3_A + axis.K_x2_A_min_per_m[direction] * w_m_per_min) +
                ripple_A;
        }
        if (index == 0 && drawn_.wrong == Wrong::x_friction && is_moving && has_contact()) {
            friction_A += sign * 360.0 / axis.K_x4_N_per_A;
        }
        const double inertial_N = axis.mass_kg * acceleration_mm_s2_along * share_of_travel / 1000.0;
        return static_cast<float>(axis.gravity_A + friction_A + (force_N + inertial_N) / axis.K_x4_N_per_A + noise_A());
    }

    void show_wrong_axes(hal::DriveSample& s) const {
        float& x = s.axis_current_A[0];
        switch (drawn_.wrong) {
            case Wrong::x_reversed:
                x = -x;
                break;
            case Wrong::x_dead:
                x = 0.0F;
                break;
            case Wrong::x_tenfold:
                x *= 10.0F;
                break;
            case Wrong::axes_swapped:
                std::swap(x, s.axis_current_A[1]);
                break;
            default:
                break;
        }
    }

    double noise_A() { return std::normal_distribution(0.0, drawn_.noise_A)(random_); }

    const DrawnCut& drawn_;
    std::mt19937_64 random_;
    double feed_mm_s_;
    double time_s_ = 0.0;
    double position_mm_ = 0.0;
    double speed_mm_s_ = rapid_mm_s;
    double face_mm_ = 1e9;
    double frozen_A_ = 0.0;
    Lagged lagged_;
};

}  // namespace

Recording record(const DrawnCut& drawn) {
    return Recorder(drawn).make();
}

}  // namespace millforce::judging
