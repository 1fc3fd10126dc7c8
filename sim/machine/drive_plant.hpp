// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

/// Spindle and feed drives as they are: inertia, cascaded loops, friction by direction with pre-sliding, gravity, heat.
/// They share nothing with the estimators: the estimators know averages and quadratics, these are differential
/// equations with hidden states. Lengths in mm, forces in N, currents in A, time in s.

namespace millforce::sim {

/// Spindle motor with current loop, PI speed loop, field weakening and a bearing friction that falls as it warms:
///     J dω/dt = K_T(ω) I − T_cut − T_idle,   K_T(ω) = K_T min(1, ω_b/|ω|),
///     T_idle = (T_0 + c |ω|) (1 + e exp(−t/τ)) · scale, against the turning; at rest it holds up to T_0.
/// At its torque limit the spindle loses speed. Steps of 0.25 ms and below are stable with loops up to 100 Hz.
struct SpindlePlantSettings {
    double torque_constant_Nm_per_A = 0.7;
    double rated_current_A = 12.0;
    double largest_current_of_rated = 2.5;  ///< the drive's torque limit
    double inertia_kg_m2 = 0.004;
    double base_speed_rad_s = 628.3;
    double speed_loop_bandwidth_hz = 25.0;  ///< tens of Hz, as industrial spindles have
    double current_loop_time_s = 0.5e-3;
    double bearing_torque_Nm = 0.45;
    double bearing_viscous_Nm_s = 0.0012;
    double cold_excess = 0.35;      ///< share by which the friction is higher when cold
    double warm_up_time_s = 240.0;  ///< time constant of the warming
    double friction_scale = 1.0;    ///< perturbation: ±20 % in the robustness runs
};

class SpindlePlant {
  public:
    explicit SpindlePlant(const SpindlePlantSettings& settings) : settings_(settings) {}

    /// `cutting_torque_Nm` brakes a spindle that turns in the cutting direction (positive speed).
    void advance(double dt_s, double commanded_speed_rad_s, double cutting_torque_Nm);
    /// Starts at speed, warm-up and loop in equilibrium: the run begins with the spindle turning.
    void start_at(double speed_rad_s);

    [[nodiscard]] double angle_rad() const { return angle_rad_; }
    [[nodiscard]] double speed_rad_s() const { return speed_rad_s_; }
    [[nodiscard]] double current_A() const { return current_A_; }
    [[nodiscard]] double idle_torque_Nm(double speed_rad_s) const;

  private:
    [[nodiscard]] double torque_constant(double speed_rad_s) const;
    void turn(double dt_s, double torque_Nm);

    SpindlePlantSettings settings_;
    double time_s_ = 0.0;
    double angle_rad_ = 0.0;
    double speed_rad_s_ = 0.0;
    double current_A_ = 0.0;
    double integral_A_ = 0.0;
};

/// Ball-screw axis: position, velocity and current loop; weight; and friction as an elastic bristle that breaks away
/// (Dahl's model with a Stribeck curve, as in Canudas de Wit et al. 1995), another in each direction, with a ripple
/// over the screw's pitch:
///     m dv/dt = K I − F_friction − F_cut − W,   F_friction = (σ z + σ_1 dz/dt + c v) · scale,
///     dz/dt = v − σ |v| z / g(v),   g(v) = F_c (1 + s exp(−(v/v_s)²)).
/// At steady speed F_friction = g(v) sign(v) + c v. At rest the bristle holds a force below break-away, F_c (1 + s),
/// with some micrometres of travel; what it holds depends on where the axis came from, and the motor's current shows
/// the rest. The position loop has no quantisation and the velocity loop integrates: so in the end the current of a
/// standing axis does carry a constant force, less what friction kept of it.
struct FeedPlantSettings {
    double force_constant_N_per_A = 120.0;
    double rated_current_A = 12.0;
    double mass_kg = 250.0;
    double coulomb_positive_N = 180.0;
    double coulomb_negative_N = 205.0;
    double stribeck_excess = 0.25;
    double stribeck_velocity_mm_s = 1.2;
    double viscous_positive_N_s_per_mm = 4.5;
    double viscous_negative_N_s_per_mm = 5.0;
    double presliding_stiffness_N_per_mm = 25000.0;  ///< some 10 µm of elastic travel before it breaks away
    double presliding_damping_N_s_per_mm = 25.0;
    double ripple_share = 0.02;  ///< share of the Coulomb friction, over the screw's pitch
    double screw_pitch_mm = 10.0;
    double weight_N = 0.0;
    double position_gain_per_s = 80.0;
    double velocity_loop_bandwidth_hz = 60.0;
    double current_loop_time_s = 0.5e-3;
    double friction_scale = 1.0;  ///< perturbation: ±20 % in the robustness runs
};

class FeedPlant {
  public:
    explicit FeedPlant(const FeedPlantSettings& settings) : settings_(settings) {}

    void start_at(double position_mm);
    /// `cutting_force_N` acts on the workpiece along this axis; the axis feels its opposite.
    void advance(double dt_s, double commanded_position_mm, double commanded_velocity_mm_s, double cutting_force_N);

    [[nodiscard]] double position_mm() const { return position_mm_; }
    [[nodiscard]] double velocity_mm_s() const { return velocity_mm_s_; }
    [[nodiscard]] double current_A() const { return current_A_; }

  private:
    [[nodiscard]] double friction_force_N(double dt_s);

    FeedPlantSettings settings_;
    double position_mm_ = 0.0;
    double velocity_mm_s_ = 0.0;
    double current_A_ = 0.0;
    double integral_A_ = 0.0;
    double presliding_mm_ = 0.0;
};

/// How a current reaches the controller.
enum class CurrentChannel : std::uint8_t {
    exact,            ///< no quantisation: for tests of the rest
    per_mille_int16,  ///< CiA 402 object 0x6078: INT16, per mille of rated current
    adc_12_bit,       ///< a 12-bit converter over ± 2.5 times the rated current
};

/// A current sensor. Noise: the ripple of the pulse-width modulation and the sensor's own noise alias into the drive's
/// sampled current as white noise; drives show about 1 % of rated current.
class CurrentSensor {
  public:
    CurrentSensor(CurrentChannel channel, double rated_current_A, double noise_share_of_rated, std::uint64_t seed)
        : channel_(channel),
          rated_A_(rated_current_A),
          noise_A_(noise_share_of_rated * rated_current_A),
          random_(seed) {}

    [[nodiscard]] double read(double current_A);

  private:
    CurrentChannel channel_;
    double rated_A_;
    double noise_A_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_{0.0, 1.0};
};

/// Incremental encoder with index: whole counts only. The index is latched as it is passed, in either direction, at the
/// count of the pulse itself. Its number is 0 until the first one and skips 0 when it wraps.
class EncoderSensor {
  public:
    EncoderSensor(std::uint32_t counts_per_rev, double index_offset_rad)
        : counts_per_rev_(counts_per_rev), index_offset_rad_(index_offset_rad) {}

    void update(double angle_rad);
    [[nodiscard]] std::uint32_t count() const { return count_; }
    [[nodiscard]] std::uint32_t index_count() const { return index_count_; }
    [[nodiscard]] std::uint8_t index_number() const { return index_number_; }

  private:
    std::uint32_t counts_per_rev_;
    double index_offset_rad_;
    std::uint32_t count_ = 0;
    std::uint32_t index_count_ = 0;
    std::uint8_t index_number_ = 0;
    std::int64_t last_turn_ = 0;
    bool started_ = false;
};

}  // namespace millforce::sim
