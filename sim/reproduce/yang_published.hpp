// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "estimation/depth_shape/depth_variation.hpp"
#include "reproduce/force_record.hpp"
#include "reproduce/yang_measurement.hpp"

/// The published tests (Tables 2–4) cut by the plant and estimated by every method.

namespace millforce::sim::yang {

/// δADOC and δRDOC in percent of nominal; NaN is "no estimate".
struct Variation {
    double axial = std::numeric_limits<double>::quiet_NaN();
    double radial = std::numeric_limits<double>::quiet_NaN();
};

enum Method : std::size_t {
    as_published,          ///< what Tables 5–7 print
    printed_on_vectors,    ///< Table 1 as printed, on the measured resultant, angles as they are read
    against_nominal,       ///< the same, angles read against the nominal cut's
    printed_on_scalars,    ///< Table 1 as printed, on flute forces added as scalars
    corrected_on_scalars,  ///< the same, III/LO and III/MO by α_sw
    profile_fit,           ///< the whole profile, the tip's angle learnt from the nominal cut
    profile_fit_alone,     ///< the whole profile, the tip's angle unknown
    method_count
};

struct Test {
    Variation truth;
    std::array<Variation, method_count> estimate;
};

/// One mill and type: the nominal cut teaches K, the angle's offset and the tip's angle; five tests follow.
struct Series {
    std::size_t mill = 0;
    std::size_t type = 0;
    std::array<Test, 5> tests{};
    estimation::ForceIndices<float> nominal_indices{};  ///< indices of the resultant
    double nominal_formula_rad = 0.0;                   ///< Table 1
};

/// A published cut with the given variations (percent); the plant's steel times `hardness`.
[[nodiscard]] SteadyCut published_cut(std::size_t mill, std::size_t type, const Variation& variation,
                                      double hardness = 1.0);
[[nodiscard]] Series published_series(std::size_t mill, std::size_t type);

/// What the published method reads off one test, PT_doc against the nominal cut's (Fig. 16).
struct TestIndices {
    double PT_doc_deg = 0.0;
    double PT_ave_N = 0.0;
};
[[nodiscard]] TestIndices test_indices(std::size_t mill, std::size_t type, std::size_t test);

/// Published method and profile fit on a material 20 % harder than the one that taught K (Table 5, mill 1, test 4):
/// by how much each estimate moves.
struct HardnessEffect {
    Variation published_method;
    Variation profile_fit;
};
[[nodiscard]] HardnessEffect hardness_effect();

[[nodiscard]] estimation::ForceIndices<float> indices_of(const IndexProfile& profile, std::size_t teeth);

}  // namespace millforce::sim::yang
