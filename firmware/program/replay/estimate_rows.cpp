// SPDX-License-Identifier: Apache-2.0
#include "replay/estimate_rows.hpp"

#include "control/cut_state.hpp"

namespace millforce::host {

void write_estimate_row(std::ostream& out, double time_s, const firmware::TickRecord& tick,
                        const firmware::ShownForces& shown) {
    std::string line = CsvWriter::cell(time_s);
    line += ',';
    line += control::name(static_cast<control::CutState>(tick.feed_override.state));
    for (const float estimate :
         {tick.tangential_force_N, tick.feed_force_N, tick.radial_immersion, tick.radial_immersion_sd,
          tick.axial_depth_mm, tick.axial_depth_sd_mm, shown.peak_N, shown.limit_N}) {
        line += ',';
        line += CsvWriter::cell(estimate);
    }
    out << line << ',' << CsvWriter::cell(tick.feed_override.ratio);
}

void ReasonCells::write(std::ostream& out, const firmware::TickRecord& tick) {
    out << ',' << CsvWriter::cell(tick.runout_um) << ',' << (tick.has_side() ? name(tick.side) : "") << ','
        << CsvWriter::cell(tick.law_misfit) << ',' << control::name(static_cast<control::Limit>(tick.limit)) << ','
        << control::name(static_cast<control::Fault>(tick.feed_override.fault));
}

}  // namespace millforce::host
