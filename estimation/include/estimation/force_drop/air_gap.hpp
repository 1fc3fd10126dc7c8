// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/measurement.hpp"
#include "estimation/signal/revolution_profile.hpp"

/// The zero of a force signal, read in process: between the exit of one tooth and the entry of the next none is in cut,
/// and what the sensor (or a drive's friction) still shows there is not force of the cut.
///
/// Valid where at least `least_bins` grid points of each gap are left after the low-pass has settled; with more teeth
/// in cut there is no gap. Variance by the scatter of the points, as if they were independent: the caller knows the
/// filter that makes them less so. Cost: 6 operations per grid point.

namespace millforce::estimation {

template <typename Scalar>
struct AirGap {
    bool valid = false;
    Scalar x_N{0};
    Scalar y_N{0};
    Scalar x_variance{0};  ///< variance of the mean
    Scalar y_variance{0};
};

/// The gap begins at `begin_rev` and is `length_rev` long, and so a pitch on for each tooth.
template <typename Scalar, int Bins>
AirGap<Scalar> read_air_gap(const RevolutionProfile<Scalar, Bins>& profile, int teeth, Scalar begin_rev,
                            Scalar length_rev) {
    constexpr int least_bins = 6;
    constexpr int margin_bins = 2;  // a helix or runout moves the edges a little
    AirGap<Scalar> gap;
    const int length = static_cast<int>(length_rev * Scalar(Bins)) - 2 * margin_bins;
    if (length < least_bins || teeth < 1) {
        return gap;
    }
    Scalar squares_x{0};
    Scalar squares_y{0};
    Scalar count{0};
    for (int tooth = 0; tooth < teeth; ++tooth) {
        const Scalar begin = (begin_rev + Scalar(tooth) / Scalar(teeth)) * Scalar(Bins);
        const int first = static_cast<int>(begin) + margin_bins;
        for (int bin = first; bin < first + length; ++bin) {
            count += Scalar(1);
            const Scalar from_x = profile.x_N(bin) - gap.x_N;
            const Scalar from_y = profile.y_N(bin) - gap.y_N;
            gap.x_N += from_x / count;
            gap.y_N += from_y / count;
            squares_x += from_x * (profile.x_N(bin) - gap.x_N);
            squares_y += from_y * (profile.y_N(bin) - gap.y_N);
        }
    }
    const Scalar per_mean = Scalar(1) / (count * (count - Scalar(1)));
    gap.x_variance = squares_x * per_mean;
    gap.y_variance = squares_y * per_mean;
    gap.valid = true;
    return gap;
}

}  // namespace millforce::estimation
