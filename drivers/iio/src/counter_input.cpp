// SPDX-License-Identifier: Apache-2.0
#include "iio/counter_input.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace millforce::iio {

bool CounterInput::read(std::uint64_t now_us) {
    std::int64_t raw = 0;
    health_.is_ready = read_raw(raw);
    if (!health_.is_ready) {
        has_last_ = has_velocity_ = false;
        return false;
    }
    const std::int64_t step = has_last_ ? step_from_last(raw) : 0;
    const std::int64_t limit = settings_.largest_step;
    const bool is_too_large = step > limit || step < -limit;
    const float elapsed_s = now_us > last_us_ ? static_cast<float>(now_us - last_us_) * 1e-6F : 0.0F;
    has_velocity_ = has_last_ && !is_too_large && elapsed_s > 0.0F;
    last_raw_ = raw;
    last_us_ = now_us;
    has_last_ = true;
    if (is_too_large) {
        ++health_.steps_too_large;
        return false;
    }
    const std::int64_t signed_step = settings_.reversed ? -step : step;
    count_ += static_cast<std::uint32_t>(signed_step);
    velocity_mm_s_ = has_velocity_ ? static_cast<float>(signed_step) * settings_.mm_per_count / elapsed_s : 0.0F;
    return true;
}

bool CounterInput::read_raw(std::int64_t& raw) {
    if (file_ < 0) {
        file_ = ::open(settings_.count_file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
        if (file_ < 0) {
            health_.fault = {IioError::file_missing, errno, settings_.count_file};
            return false;
        }
        ++health_.opened;
    }
    const Attribute text = read_attribute(file_);
    std::int64_t value = 0;
    const IioError error = text.error == IioError::none ? parse(text.view(), value) : text.error;
    if (error == IioError::none && (settings_.modulus == 0 || (value >= 0 && value < settings_.modulus))) {
        raw = value;
        return true;
    }
    health_.fault = {error == IioError::none ? IioError::not_a_number : error, text.number, settings_.count_file};
    if (text.error != IioError::none) {
        close();
    }
    return false;
}

std::int64_t CounterInput::step_from_last(std::int64_t raw) const {
    if (settings_.modulus == 0) {
        const auto step =
            static_cast<std::uint32_t>(static_cast<std::uint64_t>(raw) - static_cast<std::uint64_t>(last_raw_));
        return static_cast<std::int32_t>(step);
    }
    const std::int64_t modulus = settings_.modulus;
    const std::int64_t step = raw - last_raw_;
    if (step > modulus / 2) {
        return step - modulus;
    }
    return step < -(modulus / 2) ? step + modulus : step;
}

void CounterInput::close() {
    if (file_ >= 0) {
        ::close(file_);
    }
    file_ = -1;
}

void read_spindle(CounterInput& counter, std::uint64_t now_us, MotionReading& motion) {
    motion.has_count = counter.read(now_us);
    motion.spindle_count = counter.count();
}

void read_axis(CounterInput& counter, std::uint64_t now_us, std::size_t axis, MotionReading& motion) {
    motion.has_velocity[axis] = counter.read(now_us) && counter.has_velocity();
    motion.velocity_mm_s[axis] = counter.velocity_mm_s();
}

}  // namespace millforce::iio
