// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "files/text_lines.hpp"
#include "import/source_reader.hpp"
#include "import/text_cells.hpp"

namespace millforce::host {

/// What LinuxCNC's halsampler prints: per sample one line with a value per pin, and with its option -t the sample's
/// number before them. The pins' names come from the map.
///
/// A line "overrun" says that samples were lost before the next one. The numbers go on there, so the gap has its true
/// length. Without numbers it is not known how many were lost, and the time of all that follows would be wrong:
/// InputError, but for an "overrun" before the first sample.
class SamplerSource final : public SourceReader {
  public:
    SamplerSource(const std::string& file, const ImportMap& map, const std::vector<SourceName>& sources);

    [[nodiscard]] bool next() override;
    [[nodiscard]] std::optional<double> sample_number() const override;
    [[nodiscard]] std::string place() const override { return lines_.place(); }
    [[nodiscard]] double fraction_read() const override { return lines_.fraction_read(); }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] std::vector<std::string> notes() const override;
    [[nodiscard]] std::vector<std::string> names() const override { return pins_; }

  private:
    void read_sample();
    [[nodiscard]] double number(std::size_t cell);

    TextLines lines_;
    std::vector<std::string> pins_;
    std::vector<std::size_t> columns_;  ///< one for each source, among the pins
    std::vector<std::string> cells_;
    NumberReader numbers_;
    double sample_number_ = 0.0;
    bool has_samples_ = false;
    bool is_numbered_ = false;
    std::uint64_t overruns_ = 0;
    std::uint64_t cut_off_ = 0;
};

}  // namespace millforce::host
