// SPDX-License-Identifier: Apache-2.0
#include "replay/estimate_rows.hpp"

#include "control/cut_state.hpp"

namespace millforce::host {

void write_estimate_row(std::ostream& out, double time_s, const sim::TracePoint& p, float ratio) {
    std::string line = CsvWriter::cell(time_s);
    line += ',';
    line += control::name(static_cast<control::CutState>(p.state));
    for (const double estimate : {p.tangential_force_N, p.feed_force_N, p.radial_immersion, p.radial_immersion_sd,
                                  p.axial_depth_mm, p.axial_depth_sd_mm, p.peak_force_N, p.force_limit_N}) {
        line += ',';
        line += CsvWriter::cell(static_cast<float>(estimate));
    }
    out << line << ',' << CsvWriter::cell(ratio);
}

}  // namespace millforce::host
