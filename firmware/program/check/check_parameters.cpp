// SPDX-License-Identifier: Apache-2.0
#include "check/check_parameters.hpp"

#include "check/contradictions.hpp"
#include "check/file_units.hpp"
#include "files/console.hpp"

namespace millforce::host {

Findings check_parameters(const firmware::Parameters<float>& parameters) {
    Findings findings = check_units_of_files(parameters);
    append(findings, check_contradictions(parameters));
    return findings;
}

void show_parameter_findings(const firmware::Parameters<float>& parameters) {
    for (const Finding& finding : check_parameters(parameters)) {
        print_line(stderr, "millforce: " + line_of(finding));
    }
}

}  // namespace millforce::host
