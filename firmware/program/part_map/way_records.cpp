// SPDX-License-Identifier: Apache-2.0
#include "part_map/way_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "files/input_error.hpp"
#include "part_map/path_position.hpp"

namespace millforce::host {

namespace {

using way_window::BlockRecord;
using way_window::StretchRecord;

constexpr double um_per_mm = 1000.0;
constexpr int most_blocks_without_stretch = 16;
constexpr int most_stretches_without_block = 16;  // a window that begins within a long block need not begin with it

/// Clears `fits` where the value is outside of the range.
template <typename Whole>
Whole whole_of(float value, double per_unit, double lowest, double highest, bool& fits) {
    const double steps = std::round(static_cast<double>(value) * per_unit);
    fits = fits && steps >= lowest && steps <= highest;  // false for NaN
    return fits ? static_cast<Whole>(steps) : Whole{};
}

std::uint32_t um_of(double path_mm) {
    const double um = std::round(path_mm * um_per_mm);
    if (!(um >= 0.0 && um <= std::numeric_limits<std::uint32_t>::max())) {
        throw InputError(fmt::format("part map: the path reaches {:.0f} mm, expected 0 to 4 294 967 mm", path_mm));
    }
    return static_cast<std::uint32_t>(um);
}

BlockRecord record_of(const firmware::PathBlock<double>& block) {
    constexpr std::uint32_t longest_um = 0xFF'FFFF;
    constexpr std::uint32_t last_line = 0xFF'FFFF;
    if (block.line == 0 || block.line > last_line) {
        throw InputError(fmt::format("part map: line {}, expected 1 to {}", block.line, last_line));
    }
    const std::uint32_t end_um = um_of(block.end_mm);
    return {block.line, end_um, std::min({um_of(std::max(block.end_mm - block.begin_mm, 0.0)), end_um, longest_um})};
}

/// Puts blocks and stretches into one row.
class Row {
  public:
    void add(const BlockRecord& block) {
        records_.emplace_back(block);
        last_block_ = block;
        stretches_since_block_ = 0;
        ++blocks_since_stretch_;
    }
    /// Where two begin within the same micrometre, the second one begins one later.
    void add(StretchRecord stretch) {
        stretch.begin_um = std::max(stretch.begin_um, has_stretch_ ? last_.begin_um + 1 : 0);
        if (stretches_since_block_ >= most_stretches_without_block && stretch.begin_um < last_block_.end_um) {
            add(BlockRecord{last_block_.line, last_block_.end_um, last_block_.end_um - stretch.begin_um});
        }
        ++stretches_since_block_;
        records_.emplace_back(stretch);
        last_ = stretch;
        has_stretch_ = true;
        blocks_since_stretch_ = 0;
    }
    void repeat_where_due(std::uint32_t begin_um) {
        if (has_stretch_ && blocks_since_stretch_ >= most_blocks_without_stretch && begin_um > last_.begin_um) {
            StretchRecord again = last_;
            again.begin_um = begin_um;
            add(again);
        }
    }
    [[nodiscard]] std::vector<WayRecord> take() { return std::move(records_); }

  private:
    std::vector<WayRecord> records_;
    StretchRecord last_{};
    BlockRecord last_block_{};
    int stretches_since_block_ = 0;
    bool has_stretch_ = false;
    int blocks_since_stretch_ = 0;
};

}  // namespace

double begin_mm(const WayRecord& record) {
    if (const auto* const stretch = std::get_if<StretchRecord>(&record)) {
        return stretch->begin_um / um_per_mm;
    }
    const BlockRecord& block = std::get<BlockRecord>(record);
    return (block.end_um - block.length_um) / um_per_mm;
}

StretchRecord record_of(const control::Stretch<float>& stretch) {
    constexpr double largest_24_bits = 0xFF'FFFF;
    constexpr double largest_16_bits = 0xFFFF;
    StretchRecord record;
    bool fits = stretch.is_known;
    record.feed_um_s = whole_of<std::uint32_t>(stretch.feed_mm_s, 1e3, 1.0, largest_24_bits, fits);
    record.tangential_mN = whole_of<std::uint32_t>(stretch.tangential_N, 1e3, 0.0, largest_24_bits, fits);
    record.tooth_per_tangential_e4 =
        whole_of<std::uint32_t>(stretch.tooth_per_tangential, 1e4, 0.0, largest_24_bits, fits);
    record.feed_per_tangential_e3 = whole_of<std::int16_t>(stretch.feed_per_tangential, 1e3, -32'768.0, 32'767.0, fits);
    record.falling_share_e4 = whole_of<std::uint16_t>(stretch.falling_share, 1e4, 1.0, 1e4, fits);
    record.feed_per_softness_e3 = whole_of<std::uint16_t>(stretch.feed_per_softness, 1e3, 1.0, largest_16_bits, fits);
    record.least_share_percent = whole_of<std::uint8_t>(stretch.least_share, 1e2, 0.0, 1e2, fits);
    if (!fits) {
        record = {.least_share_percent = StretchRecord::unknown_percent};
    }
    record.begin_um = um_of(static_cast<double>(stretch.begin_mm));
    return record;
}

std::vector<WayRecord> way_records(const PartMap& map, const firmware::Parameters<float>& parameters) {
    const std::vector<firmware::PathBlock<double>> blocks = path_blocks(map);
    const std::vector<control::Stretch<float>> stretches = stretches_of(map, parameters);
    Row row;
    auto next = stretches.begin();
    const auto add_stretches_before = [&](double path_mm) {
        for (; next != stretches.end() && static_cast<double>(next->begin_mm) < path_mm; ++next) {
            row.add(record_of(*next));
        }
    };
    for (const firmware::PathBlock<double>& block : blocks) {
        add_stretches_before(block.begin_mm);
        row.repeat_where_due(um_of(block.begin_mm));
        row.add(record_of(block));
    }
    add_stretches_before(std::numeric_limits<double>::infinity());
    return row.take();
}

}  // namespace millforce::host
