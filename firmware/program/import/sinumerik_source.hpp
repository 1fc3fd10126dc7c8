// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "import/source_reader.hpp"
#include "import/text_cells.hpp"
#include "import/xml_tags.hpp"

namespace millforce::host {

/// The XML file that the trace of SINUMERIK Operate saves ("SINUMERIK Solution Line Trace"):
///
///     <traceSession> … <traceData><dataFrame>
///       <dataSignal id="f1" name="/Nck/!SD/nckServoDataActCurr32 [u1, 7]" description="…" interval="0.002" …/>
///       <rec time="0.000000" f1="-0.798340" f2="4"/>
///       <rec time="0.002000" f2="5"/>
///
/// A signal is asked for by its `name`, its `id`, or its `description` if only one has that. The file does not state
/// units (`unitsType` is "current" or "velo"): the map does.
///
/// A signal that has not changed is left out of a record, and a record in which nothing has changed is left out of the
/// file. So a signal keeps its value until the next one, and records are put in at the shortest `interval` where up to
/// a second of them is missing; a longer one is a gap. Values at or above 2^63 are bits of "not a number": none. A
/// second <dataFrame> is refused.
class SinumerikSource final : public SourceReader {
  public:
    SinumerikSource(const std::string& file, const std::vector<SourceName>& sources);

    [[nodiscard]] bool next() override;
    [[nodiscard]] double time_s() const override { return time_s_; }
    [[nodiscard]] std::string place() const override { return tags_.place(); }
    [[nodiscard]] double fraction_read() const override { return tags_.fraction_read(); }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] std::vector<std::string> notes() const override;
    [[nodiscard]] std::vector<std::string> names() const override;

  private:
    struct Signal {
        std::string id;
        std::string name;
        std::string description;
    };
    void read_signals();
    void take_signal();
    void find_sources(const std::vector<SourceName>& sources);
    [[nodiscard]] bool read_record();
    void take_record();
    void plan_left_out_records(double record_s);
    [[nodiscard]] double attribute_number(const std::string& name, bool is_required);

    XmlTags tags_;
    NumberReader numbers_;
    std::vector<Signal> signals_;
    std::vector<std::string> ids_;  ///< one for each source
    double interval_s_ = 0.0;
    double time_s_ = 0.0;
    double record_s_ = 0.0;  ///< time of the record that is the tag now
    bool has_record_ = false;
    std::uint64_t left_out_ = 0;  ///< records still to be put in before it
    std::uint64_t put_in_ = 0;
};

}  // namespace millforce::host
