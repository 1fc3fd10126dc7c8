// SPDX-License-Identifier: Apache-2.0
#include "check/check_parameters.hpp"

#include "check/contradictions.hpp"
#include "check/file_units.hpp"

namespace millforce::host {

Findings check_parameters(const firmware::Parameters<float>& parameters) {
    Findings findings = check_units_of_files(parameters);
    append(findings, check_contradictions(parameters));
    return findings;
}

}  // namespace millforce::host
