// SPDX-License-Identifier: Apache-2.0
#include "soak/repeated_part.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace millforce::soak {

namespace {

constexpr double feed_mm_s = 20.0;
constexpr double rapid_mm_s = 100.0;
constexpr std::uint64_t revolutions = 1999;  // in 30 s: 3998 rpm, so that no revolution has a whole number of samples
constexpr double to_full_cut_s = 0.3;        // a cut begins and ends over 6 mm: the cutter's radius, and a little

/// Where the counters begin: 20 s of the first part, then they wrap.
constexpr std::uint64_t before_wrap_us = 20'000'000;
constexpr std::uint64_t before_wrap_revolutions = 1332;
constexpr std::uint64_t first_index_number = 250;
constexpr std::uint64_t range_of_32_bits = 1ULL << 32U;
constexpr std::uint64_t range_of_8_bits = 1ULL << 8U;

struct Section {
    double duration_s;
    double speed_mm_s;
    std::size_t axis;
    double tangential_N;  // 0: air
    double feed_ratio;    // F_ax/F_at at the begin and at the end
    double last_feed_ratio;
};
constexpr std::array<Section, 10> sections{{{1.0, 0.0, 0, 0.0, 0.0, 0.0},
                                            {1.5, rapid_mm_s, 0, 0.0, 0.0, 0.0},
                                            {2.0, feed_mm_s, 1, 0.0, 0.0, 0.0},
                                            {9.0, feed_mm_s, 0, 250.0, -0.75, -0.2},
                                            {1.0, feed_mm_s, 0, 0.0, 0.0, 0.0},
                                            {8.0, feed_mm_s, 1, 150.0, -0.6, -0.6},
                                            {1.5, feed_mm_s, 1, 0.0, 0.0, 0.0},
                                            {4.0, feed_mm_s, 0, 300.0, -0.4, -0.4},
                                            {1.0, feed_mm_s, 0, 0.0, 0.0, 0.0},
                                            {1.0, 0.0, 0, 0.0, 0.0, 0.0}}};

/// 0…1, from its own begin and to its own end.
double share_of_cut(const Section& section, double since_s) {
    const double to_end_s = section.duration_s - since_s;
    return std::fmin(1.0, std::fmin(since_s, to_end_s) / to_full_cut_s);
}

class Noise {
  public:
    explicit Noise(std::uint32_t seed) : engine_(seed) {}
    /// Even, and so the same with each standard library.
    double operator()(double largest) { return largest * (static_cast<double>(engine_()) / 2147483648.0 - 1.0); }

  private:
    std::mt19937 engine_;
};

hal::DriveSample signals(const firmware::Parameters<float>& p, const Section& section, double since_s, double time_s,
                         Noise& noise) {
    constexpr double ripple_share = 0.3;
    const double turned_rev = time_s * static_cast<double>(revolutions) / 30.0;
    const double tooth_phase = 2.0 * std::numbers::pi * static_cast<double>(p.tool.teeth) * turned_rev;
    const double load =
        section.tangential_N * share_of_cut(section, since_s) * (1.0 + ripple_share * std::sin(tooth_phase));
    const double torque_Nm = load * static_cast<double>(p.tool.diameter_mm) * 0.0005;
    const double along = since_s / section.duration_s;
    const double feed_N = load * (section.feed_ratio + (section.last_feed_ratio - section.feed_ratio) * along);
    hal::DriveSample sample;
    sample.present = hal::all_present;
    sample.spindle_current_A =
        (static_cast<float>(torque_Nm) - p.machine.spindle.K_t2_Nm) / p.machine.spindle.K_t1_Nm_per_A +
        static_cast<float>(noise(0.05));
    for (std::size_t k = 0; k < hal::axis_count; ++k) {
        const auto& axis = p.machine.axes[k];
        const bool moves = k == section.axis && section.speed_mm_s > 0.0;
        const auto speed_mm_s = static_cast<float>(moves ? section.speed_mm_s : 0.0);
        const float friction_A = moves ? axis.positive.at(speed_mm_s * 0.06F) + axis.K_x3_A : 0.0F;
        const float cutting_A = moves ? static_cast<float>(feed_N) / axis.K_x4_N_per_A : 0.0F;
        sample.axis_velocity_mm_s[k] = speed_mm_s;
        sample.axis_current_A[k] = friction_A + cutting_A + static_cast<float>(noise(0.03));
    }
    return sample;
}

}  // namespace

RepeatedPart::RepeatedPart(const firmware::Parameters<float>& parameters, std::uint32_t seed)
    : counts_per_rev_(parameters.machine.encoder_counts_per_rev) {
    Noise noise(seed);
    double time_s = 0.0;
    for (const Section& section : sections) {
        const auto count = static_cast<int>(std::lround(section.duration_s * 1e6 / sample_interval_us));
        for (int k = 0; k < count; ++k) {
            const double since_s = static_cast<double>(k) * 1e-6 * sample_interval_us;
            samples_.push_back(signals(parameters, section, since_s, time_s + since_s, noise));
            hal::ProgramStatus program;
            program.programmed_feed_mm_s = static_cast<float>(feed_mm_s);
            program.rapid = section.speed_mm_s > feed_mm_s;
            programs_.push_back(program);
        }
        time_s += section.duration_s;
    }
}

std::uint64_t RepeatedPart::turned_counts(std::uint64_t part, std::size_t index) const {
    const std::uint64_t per_part = revolutions * counts_per_rev_;
    return part * per_part + static_cast<std::uint64_t>(index) * per_part / size();
}

hal::DriveSample RepeatedPart::sample(std::uint64_t part, std::size_t index) const {
    const std::uint64_t first_time_us = range_of_32_bits - before_wrap_us;
    const std::uint64_t first_count = range_of_32_bits - before_wrap_revolutions * counts_per_rev_;
    const std::uint64_t turned = turned_counts(part, index);
    const std::uint64_t turned_rev = turned / counts_per_rev_;
    hal::DriveSample sample = samples_[index];
    sample.time_us = static_cast<std::uint32_t>(first_time_us + (part * size() + index) * sample_interval_us);
    sample.spindle_count = static_cast<std::uint32_t>(first_count + turned);
    sample.spindle_index_count = static_cast<std::uint32_t>(first_count + turned_rev * counts_per_rev_);
    sample.spindle_index_number = static_cast<std::uint8_t>(first_index_number + turned_rev);
    return sample;
}

RepeatedPart::Wraps RepeatedPart::wraps_after(std::uint64_t parts) const {
    const std::uint64_t time_us = range_of_32_bits - before_wrap_us + parts * size() * sample_interval_us;
    const std::uint64_t count = range_of_32_bits - before_wrap_revolutions * counts_per_rev_ + turned_counts(parts, 0);
    const std::uint64_t index = first_index_number + turned_counts(parts, 0) / counts_per_rev_;
    return {time_us / range_of_32_bits, count / range_of_32_bits, index / range_of_8_bits};
}

}  // namespace millforce::soak
