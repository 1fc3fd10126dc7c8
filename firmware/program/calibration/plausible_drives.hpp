// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/plausible_units.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

/// What spindles and feed axes cannot do, or few of them do, and a wrong unit explains: as plausible_units.hpp, of the
/// drives' own data.

namespace millforce::host {

/// A spindle's row of known torque.
struct SpindleLoad {
    double torque_Nm = 0.0;
    double speed_rad_s = 0.0;
    double current_A = 0.0;

    [[nodiscard]] double power_W() const;
    [[nodiscard]] double W_per_A() const;
};

/// Where a spindle's speed comes from: the words of its likely mistakes.
enum class SpeedSource { column, angle };

/// The load of most power: 1 to 2400 W for each ampere. No drive gives more power than √3 U I, U at most 690 V, twice
/// that where the idle current was taken off; at less than 1 W the motor would take less than a volt.
void refuse_implausible_power(const std::string& file, const SpindleLoad& load, SpeedSource source);

/// The fastest speed of a recording or table: 5 rad/s, at which Ø500 mm cuts at 75 m/min, to 20 000 rad/s, as the
/// fastest air bearings have.
void refuse_implausible_spindle_speed(const std::string& file, double fastest_rad_s, SpeedSource source);

/// The speeds at which torques were measured, and what the drive gave at the fastest.
struct SpindleSpeeds {
    std::vector<double> speeds_rad_s;
    double W_per_A = no_estimate;     ///< of the load of most power
    double base_speed_rad_s = 0.0;    ///< 0: no field weakening was seen
    double base_speed_W_per_A = 0.0;  ///< K_t1 times the base speed
    bool of_one_angle = false;        ///< the speed is one average of a recorded angle: it is round by chance
};
/// Asks about speeds above 3000 rad/s; about more than 1200 W for each ampere (690 V); about speeds of which each is a
/// multiple of 50, from 500 rad/s up, as one chooses them in 1/min; about speeds that are round only in 1/s; and about
/// less than 100 W for each ampere (58 V) where the field is weakened, for which the drive's voltage must be used up,
/// or up to 100 rad/s.
UnitQuestions ask_about_spindle_speeds(const SpindleSpeeds& spindle);

/// An idling spindle's current: at most 1000 A and the rated one of the machine's file (0: not known), and a torque of
/// a twentieth to twenty times the file's (0: not known). Bearings change by a factor of 3 from cold to warm.
struct IdlingSpindle {
    double current_A = 0.0;
    double torque_Nm = 0.0;
    double rated_current_A = 0.0;
    double torque_of_file_Nm = 0.0;
};
void refuse_implausible_idling(const std::string& file, const IdlingSpindle& idling);

/// Asks about a gain that is not a third to three times that of the machine's file (0: not known).
UnitQuestions ask_about_gain(std::string_view key, double fitted, double of_file);

/// An axis' recorded velocities. Acceleration is the change from one average over 10 ms to the next; a single spike
/// changes nothing, since the fourth largest counts.
class AxisMotionUnits {
  public:
    void look_at(double time_s, double velocity_mm_s);
    /// The next sample does not follow on the last one.
    void interrupt();
    /// `longest_travel_m`: of the stretches at a steady feed. Throws above 50 m/s² (5 g; the fastest linear drives have
    /// 3 g), and for a travel of more than 10 m with samples more than 0.2 s apart.
    void refuse_implausible(const std::string& file, char axis, double longest_travel_m) const;
    /// Asks above 1000 mm/s (60 m/min), above 15 m/s², which ball screws do not reach, and below 0.05 m/s², 3 s to 10
    /// m/min.
    [[nodiscard]] UnitQuestions questions(char axis) const;

  private:
    static constexpr std::size_t fewest_changes = 4;

    struct Block {
        double start_s = 0.0;
        double sum_mm_s = 0.0;
        long samples = 0;
    };
    struct Average {
        double middle_s = 0.0;
        double velocity_mm_s = 0.0;
    };
    void end_block(double time_s);
    void add_acceleration(double acceleration_m_s2);
    [[nodiscard]] double interval_s() const;

    Block block_;
    bool has_average_ = false;
    Average average_;
    std::array<double, fewest_changes> largest_m_s2_{};  ///< the largest ones first
    double first_s_ = no_estimate;
    double last_s_ = 0.0;
    double fastest_mm_s_ = 0.0;
    long samples_ = 0;
};

/// Asks about a mean friction of more than 20 A in air: the largest axis drives have a rated current of some 100 A.
UnitQuestions ask_about_axis_friction(char axis, double friction_A);

/// Samples of a motion: at most 0.2 s apart, or its acceleration cannot be seen.
void refuse_implausible_interval(const std::string& file, double interval_s);

/// Of an axis that moves: 0.2 kg to 200 t; asks below 5 kg and above 20 t.
UnitQuestions look_at_axis_mass(const std::string& file, double mass_kg);

}  // namespace millforce::host
