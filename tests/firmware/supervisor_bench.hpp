// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "firmware/signal_supervisor.hpp"
#include "firmware/tick_bench.hpp"

/// The supervisor without the tick: each estimate and each sample is made up.

namespace millforce::test {

using control::CutState;
using control::Fault;
using Estimate = estimation::CutEstimate<float>;
using Force = estimation::Measurement<float>;
using Supervisor = firmware::SignalSupervisor<float>;

inline Force known_N(float value) {
    return {.valid = true, .value = value, .variance = 1.0F};
}

/// One revolution of four teeth at 4000 rpm in 15 ms, in a steady level move without a force.
inline Estimate revolution() {
    Estimate e;
    e.tooth_periods = 4;
    e.tangential_N = known_N(0.0F);
    e.feed_mm_s = feed_mm_s;
    e.feed_per_tooth_mm = 0.075F;
    e.spindle_speed_rad_s = 418.88F;
    e.tooth_change.feed_is_steady = true;
    return e;
}

inline Estimate one_tooth() {
    Estimate e = revolution();
    e.tooth_periods = 1;
    return e;
}

/// One tooth after which a force of 250 N is 50 N.
inline Estimate fallen_force() {
    Estimate e = one_tooth();
    e.tooth_tangential_N = known_N(50.0F);
    e.tooth_change.tangential_N = known_N(-200.0F);
    return e;
}

inline Fault judged(Supervisor& supervisor, const Estimate& e, int times, CutState state = CutState::air,
                    const hal::ProgramStatus& status = program()) {
    for (int k = 0; k < times; ++k) {
        supervisor.judge(e, status, state, true);
    }
    return supervisor.fault();
}

/// Of one tooth's change after `steady_teeth` that are `usual`, and a revolution later.
inline Fault of_change_among(Supervisor& supervisor, const Estimate& usual, const Estimate& change,
                             int steady_teeth = 8, CutState state = CutState::in_cut) {
    judged(supervisor, usual, steady_teeth, state);
    judged(supervisor, change, 1, state);
    return judged(supervisor, usual, 6, state);
}

inline Fault of_change(const Estimate& change, int steady_teeth = 8, CutState state = CutState::in_cut) {
    Supervisor supervisor(machine_and_tool());
    return of_change_among(supervisor, one_tooth(), change, steady_teeth, state);
}

/// Index pulses from `number` on, `step` numbers and `counts` counts apart, each in one sample.
inline Fault of_index_pulses(Supervisor& supervisor, int pulses, unsigned step, std::uint32_t counts,
                             std::uint8_t present = hal::all_present) {
    hal::DriveSample sample;
    sample.present = present;
    for (int k = 0; k < pulses; ++k) {
        sample.spindle_index_number = static_cast<std::uint8_t>(1U + static_cast<unsigned>(k) * step);
        sample.spindle_index_count = 1'000'000U + static_cast<std::uint32_t>(k) * counts;
        supervisor.take(sample, 0.001F, CutState::air);
    }
    return supervisor.fault();
}

/// A spindle that turns and an x axis that moves, and what the supervisor says of their currents.
class Currents {
  public:
    Currents() {
        sample_.present = hal::all_present;
        sample_.axis_velocity_mm_s[0] = feed_mm_s;
        turn();
    }
    void turn() { judged(supervisor_, revolution(), 1); }
    Fault noisy_spindle(int samples, CutState state, int equal_values = 1) {
        return take(samples, state, equal_values, sample_.spindle_current_A);
    }
    Fault noisy_axis(std::size_t axis, int samples, CutState state) {
        return take(samples, state, 1, sample_.axis_current_A[axis]);
    }
    Fault same(int samples, CutState state) { return take(samples, state, samples, unused_); }
    hal::DriveSample& sample() { return sample_; }
    Supervisor& supervisor() { return supervisor_; }

  private:
    Fault take(int samples, CutState state, int equal_values, float& noisy_A) {
        for (int k = 0; k < samples; ++k) {
            ++count_;
            sample_.spindle_count += 273U;
            if (k % equal_values == 0) {
                noisy_A = 1.0F + 0.05F * std::sin(static_cast<float>(count_ * count_));
            }
            supervisor_.take(sample_, 0.001F, state);
        }
        return supervisor_.fault();
    }

    Supervisor supervisor_{machine_and_tool()};
    hal::DriveSample sample_{};
    float unused_ = 0.0F;
    int count_ = 0;
};

}  // namespace millforce::test
