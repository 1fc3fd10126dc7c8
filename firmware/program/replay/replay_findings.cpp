// SPDX-License-Identifier: Apache-2.0
#include "replay/replay_findings.hpp"

#include <fmt/format.h>

#include "control/cut_state.hpp"
#include "estimation/engagement/side_choice.hpp"
#include "replay/slow_samples.hpp"

namespace millforce::host {

namespace {

constexpr std::size_t few_samples = 20;  // in which no force is to be expected
constexpr std::size_t often = 20;        // one in so many: the right law is refuted in one window of 3,000
constexpr float misfit_of_a_wrong_law = estimation::misfit_of_a_wrong_model<float>;

}  // namespace

void ReplayFindings::follow(const hal::DriveSample& sample, const firmware::TickRecord& record) {
    time_us_ += samples_ == 0 ? 0 : sample.time_us - last_time_us_;
    last_time_us_ = sample.time_us;
    follow_turning(sample);
    ++samples_;
    without_current_ += (sample.present & hal::mask(hal::Present::spindle_current)) == 0 ? 1U : 0U;
    with_law_ += record.has_side() ? 1U : 0U;
    refuted_ += record.law_misfit > misfit_of_a_wrong_law ? 1U : 0U;
    with_force_ += record.tangential_force_N == record.tangential_force_N ? 1U : 0U;
    if (record.feed_override.fault != 0) {
        first_fault_ = in_fault_ == 0 ? record.feed_override.fault : first_fault_;
        fault_us_ = in_fault_ == 0 ? time_us_ : fault_us_;
        ++in_fault_;
    }
}

void ReplayFindings::follow_turning(const hal::DriveSample& sample) {
    const auto turned = static_cast<std::int32_t>(sample.spindle_count - last_count_);
    last_count_ = sample.spindle_count;
    if (samples_ == 0) {
        return;
    }
    const double turned_rev = static_cast<double>(turned) / counts_per_rev_;
    at_rest_ += turned == 0 ? 1U : 0U;
    backwards_ += turned < 0 ? 1U : 0U;
    too_far_ += turned_rev >= farthest_rev ? 1U : 0U;
}

std::string ReplayFindings::reason_for_no_force() const {
    const auto is_most = [this](std::size_t count) { return 2 * count > samples_; };
    if (is_most(without_current_)) {
        return "the spindle's current is missing";
    }
    if (is_most(too_far_)) {
        return fmt::format(
            "the spindle turns by {} revolutions or more between two samples; expected samples that are "
            "closer, and an angle in rad",
            farthest_rev);
    }
    if (is_most(at_rest_)) {
        return "the spindle does not turn; expected its angle in rad, not a speed";
    }
    if (is_most(backwards_)) {
        return "the spindle turns backwards; expected an angle that grows in the cutting direction";
    }
    return "in air the spindle's current is not that of the machine's file; expected amperes, and [spindle] of this "
           "machine";
}

std::vector<std::string> ReplayFindings::notes() const {
    std::vector<std::string> notes;
    if (samples_ > few_samples && 2 * with_force_ < samples_) {
        notes.push_back(fmt::format("a force in {} of {} samples: {}", with_force_, samples_, reason_for_no_force()));
    }
    if (refuted_ > few_samples && often * refuted_ > with_law_) {
        notes.push_back(fmt::format(
            "the tool's law does not explain the forces (law_misfit above {}) in {} of {} samples of the cut, and "
            "there "
            "is no immersion there; look at the axes' currents (friction, sign, which is x), and at the material",
            estimation::misfit_of_a_wrong_model<float>, refuted_, with_law_));
    }
    if (in_fault_ > 0) {
        std::string note = fmt::format("fault '{}' at {:.3f} s after the begin, and in {} of {} samples",
                                       control::name(static_cast<control::Fault>(first_fault_)),
                                       static_cast<double>(fault_us_) / 1e6, in_fault_, samples_);
        if (static_cast<control::Fault>(first_fault_) == control::Fault::overload) {
            note += "; where no tooth was near its limit, look at the units: currents in A, velocities in mm/s";
        }
        notes.push_back(note);
    }
    return notes;
}

}  // namespace millforce::host
