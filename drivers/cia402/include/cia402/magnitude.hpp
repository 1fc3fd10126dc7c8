// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace millforce::cia402 {

/// |value|; NaN stays NaN.
constexpr float magnitude(float value) {
    return value < 0.0F ? -value : value;
}

}  // namespace millforce::cia402
