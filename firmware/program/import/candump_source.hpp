// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "candump/log_line.hpp"
#include "files/text_lines.hpp"
#include "import/dbc.hpp"
#include "import/source_reader.hpp"

namespace millforce::host {

/// A candump log (`candump -L`), decoded with the DBC file of the map. Each frame of a message with a signal that is
/// asked for is a record; its time is that of the frame, from the first frame of the first log on.
///
/// A frame that is too short for a signal gives none. Frames of CAN FD and error frames are passed over and counted.
/// InputError: a line that candump does not write, frames of several interfaces where the map names none.
class CandumpSource final : public SourceReader {
  public:
    CandumpSource(const std::string& file, const ImportMap& map, const std::vector<SourceName>& sources,
                  SourceContext& context);

    [[nodiscard]] bool next() override;
    [[nodiscard]] double time_s() const override { return time_s_; }
    [[nodiscard]] bool has_whole_records() const override { return by_message_.size() <= 1; }
    [[nodiscard]] std::string place() const override { return lines_.place(); }
    [[nodiscard]] double fraction_read() const override { return lines_.fraction_read(); }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] std::vector<std::string> notes() const override;
    [[nodiscard]] std::vector<std::string> names() const override;

  private:
    using MessageId = std::pair<std::uint32_t, bool>;  ///< and whether it has 29 bits

    [[nodiscard]] candump::LogLine read_line();
    [[nodiscard]] bool is_of_interface(std::string_view interface);
    [[nodiscard]] bool take_frame(const hal::CanFrame& frame);

    TextLines lines_;
    std::string interface_;
    bool interface_is_given_;
    Dbc dbc_;
    std::vector<DbcSignal> signals_;  ///< one for each source
    std::map<MessageId, std::vector<std::size_t>> by_message_;
    SourceContext& context_;
    double time_s_ = 0.0;
    std::uint64_t frames_ = 0;
    std::uint64_t used_frames_ = 0;
    std::uint64_t short_frames_ = 0;
    std::uint64_t other_frames_ = 0;
    std::uint64_t cut_off_ = 0;
};

}  // namespace millforce::host
