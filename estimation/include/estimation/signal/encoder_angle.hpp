// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace millforce::estimation {

/// What one encoder reading showed. Those after `standstill` end the present average.
enum class EncoderEvent : unsigned char {
    none,
    forward,        ///< turned in the cutting direction
    standstill,     ///< no count, or a jitter of one count backwards
    reversed,       ///< turned against the cutting direction
    too_fast,       ///< turned by 0.45 revolutions or more between two readings: the direction is not known
    index_slipped,  ///< counts between two index pulses are not a whole number of revolutions: counts were lost
    index_found     ///< the first index pulse: the angle up to it had begun anywhere, and has jumped
};

template <typename Scalar>
struct EncoderReading {
    EncoderEvent event = EncoderEvent::none;
    Scalar turned_rev{0};  ///< since the last accepted reading, in revolutions, ≥ 0
    Scalar angle_rev{0};   ///< after it, 0…1 from the index (from the first reading where no index is wired)

    /// No average may span this reading.
    [[nodiscard]] bool is_break() const { return event > EncoderEvent::standstill; }
};

/// Spindle angle from encoder counts and index pulse.
///
/// The count is taken modulo 2³²; the angle is the count since the index, modulo counts_per_rev. When an index pulse
/// comes where the count does not expect it (± tolerance), the index wins and the reading says `index_slipped`, at the
/// first one `index_found`.
/// A direction change is reported once per reading; a jitter of one count is not a reversal.
/// Readings must be less than 0.45 revolutions apart. Integer arithmetic only, no accumulation of rounding.
/// Not thread-safe; about 30 instructions a reading.
template <typename Scalar>
class EncoderAngle {
  public:
    explicit EncoderAngle(std::uint32_t counts_per_rev = 4096)
        : counts_per_rev_(counts_per_rev),
          too_many_(static_cast<std::int32_t>(counts_per_rev / 20U * 9U)),
          rev_per_count_(Scalar(1) / static_cast<Scalar>(counts_per_rev)) {}

    void reset() { started_ = false; }

    EncoderReading<Scalar> update(std::uint32_t count, std::uint32_t index_count, std::uint8_t index_number) {
        EncoderReading<Scalar> reading;
        const auto turned = static_cast<std::int32_t>(count - last_count_);
        // Likely: every sample of a turning spindle comes here, and its path shall be the one without a jump.
        if (started_ && turned > 0 && turned < too_many_) [[likely]] {
            reading.event = EncoderEvent::forward;
            reading.turned_rev = static_cast<Scalar>(turned) * rev_per_count_;
            last_count_ = count;
        } else if (!started_) {
            start(count, index_count, index_number);
            reading.angle_rev = angle_rev();
            return reading;
        } else {
            reading.event = other_event(turned);
            last_count_ = reading.event == EncoderEvent::standstill ? last_count_ : count;
        }
        if (index_number != last_index_number_) {
            take_index(index_count, index_number, reading);
        }
        reading.angle_rev = angle_rev();
        return reading;
    }

    [[nodiscard]] std::uint32_t counts_per_rev() const { return counts_per_rev_; }

  private:
    /// After the last reading.
    [[nodiscard]] Scalar angle_rev() {
        std::uint32_t since_zero = last_count_ - zero_count_;
        if (since_zero >= counts_per_rev_) {
            since_zero = modulo(since_zero);
            zero_count_ = last_count_ - since_zero;  // so near that the 32-bit difference never wraps
        }
        return static_cast<Scalar>(since_zero) * rev_per_count_;
    }

    void start(std::uint32_t count, std::uint32_t index_count, std::uint8_t index_number) {
        started_ = true;
        last_count_ = count;
        zero_count_ = index_number == 0 ? count : index_count;
        last_index_number_ = index_number;
    }

    /// Of a reading that is not `forward`.
    [[nodiscard]] EncoderEvent other_event(std::int32_t turned) const {
        if (turned >= too_many_ || turned <= -too_many_) {
            return EncoderEvent::too_fast;
        }
        return turned >= -1 ? EncoderEvent::standstill : EncoderEvent::reversed;
    }

    void take_index(std::uint32_t index_count, std::uint8_t index_number, EncoderReading<Scalar>& reading) {
        const bool first_index = last_index_number_ == 0;
        last_index_number_ = index_number;
        const std::uint32_t remainder = modulo(index_count - zero_count_);
        const std::uint32_t tolerance = counts_per_rev_ / index_tolerances_per_rev + 1U;
        if (remainder > tolerance && counts_per_rev_ - remainder > tolerance) {
            reading.event = first_index ? EncoderEvent::index_found : EncoderEvent::index_slipped;
        }
        zero_count_ = index_count;
    }

    /// (difference mod 2³²) mod counts_per_rev, read as a signed difference so that a zero ahead of the count works.
    [[nodiscard]] std::uint32_t modulo(std::uint32_t difference) const {
        const auto period = static_cast<std::int32_t>(counts_per_rev_);
        const std::int32_t rest = static_cast<std::int32_t>(difference) % period;
        return static_cast<std::uint32_t>(rest < 0 ? rest + period : rest);
    }

    /// A third of a degree, for the width of the index pulse.
    static constexpr std::uint32_t index_tolerances_per_rev = 1024;

    std::uint32_t counts_per_rev_;
    std::int32_t too_many_;  // counts between two readings: 0.45 revolutions
    Scalar rev_per_count_;
    std::uint32_t last_count_ = 0;
    std::uint32_t zero_count_ = 0;
    std::uint8_t last_index_number_ = 0;
    bool started_ = false;
};

}  // namespace millforce::estimation
