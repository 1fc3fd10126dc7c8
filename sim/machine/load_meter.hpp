// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace millforce::sim {

/// A spindle current as a frequency converter reports it to a Modbus master: smoothed by the converter, asked for once
/// per period, answered some time later, and valid until the next answer.
struct LoadMeterSettings {
    double period_s = 0.0;      ///< between two answers; 0: the current itself is read with each sample
    double age_s = 0.0;         ///< age of an answer when it arrives
    double smoothing_s = 0.0;   ///< time constant of the converter's display filter
    double resolution_A = 0.1;  ///< resolution of the answer

    [[nodiscard]] bool is_there() const { return period_s > 0.0; }
};

class LoadMeter {
  public:
    explicit LoadMeter(const LoadMeterSettings& settings) : settings_(settings) {}

    void start_at(double current_A) {
        smooth_A_ = current_A;
        shown_A_ = current_A;
    }
    void advance(double dt_s, double current_A) {
        time_s_ += dt_s;
        const double share = settings_.smoothing_s > 0.0 ? 1.0 - std::exp(-dt_s / settings_.smoothing_s) : 1.0;
        smooth_A_ += share * (current_A - smooth_A_);
        if (time_s_ >= next_question_s_) {
            next_question_s_ += settings_.period_s;
            under_way_.push_back({time_s_ + settings_.age_s, smooth_A_});
        }
        while (!under_way_.empty() && time_s_ >= under_way_.front().arrives_s) {
            shown_A_ = under_way_.front().current_A;
            under_way_.erase(under_way_.begin());
        }
    }
    [[nodiscard]] double shown_A() const {
        return std::round(shown_A_ / settings_.resolution_A) * settings_.resolution_A;
    }

  private:
    struct Answer {
        double arrives_s;
        double current_A;
    };

    LoadMeterSettings settings_;
    std::vector<Answer> under_way_;
    double time_s_ = 0.0;
    double next_question_s_ = 0.0;
    double smooth_A_ = 0.0;
    double shown_A_ = 0.0;
};

}  // namespace millforce::sim
