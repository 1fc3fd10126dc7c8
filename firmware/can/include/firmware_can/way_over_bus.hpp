// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "control/feed_ahead.hpp"
#include "estimation/number/fixed_point.hpp"
#include "firmware/along_path.hpp"
#include "firmware/path_position.hpp"
#include "firmware/way_source.hpp"
#include "way_window/way_receiver.hpp"

/// The part map of a controller without files: a window of it, handed over on the bus (way_frames.hpp).
///
/// The window holds 64 stretches of the cut and 64 blocks of the program. What the tool has passed makes room. Where
/// the window runs dry, where no block of it fits what the CNC reports, or where no sender is there, nothing is known
/// of the way ahead: the feed has fallen to the blind one by then, and the cut goes on.
///
/// A session that begins empties the window. In the same run of a program a map that the cut has refuted stays so. If
/// the tool's place jumps back, the program has begun again, and the window waits for a session.
///
/// It speaks when it is asked, and never else. No heap. One thread. RAM: sizeof, 3.6 kB in float. Cost of a sample:
/// that of FeedAhead.

namespace millforce::firmware {

/// The blocks around the tool, in the order of the path.
template <typename Scalar>
class BlockWindow {
  public:
    static constexpr std::size_t capacity = way_window::largest_window;

    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] std::size_t room() const { return capacity - count_; }
    [[nodiscard]] const PathBlock<Scalar>& operator[](std::size_t i) const { return blocks_[(first_ + i) % capacity]; }
    void clear() { count_ = 0; }
    /// False, and nothing is added, where there is no room or the block ends before the last one.
    bool add(const PathBlock<Scalar>& block) {
        if (room() == 0 || (count_ > 0 && block.end_mm < (*this)[count_ - 1].end_mm)) {
            return false;
        }
        blocks_[(first_ + count_) % capacity] = block;
        ++count_;
        return true;
    }
    /// The last one stays.
    void drop_before(Scalar path_mm) {
        while (count_ > 1 && (*this)[0].end_mm < path_mm) {
            first_ = (first_ + 1) % capacity;
            --count_;
        }
    }

  private:
    std::array<PathBlock<Scalar>, capacity> blocks_{};
    std::size_t first_ = 0;
    std::size_t count_ = 0;
};

template <typename Scalar>
class WayOverBus final : public WaySource<Scalar> {
  public:
    using Ahead = control::FeedAhead<Scalar, control::small_window>;
    static_assert(control::small_window == way_window::largest_window);

    /// `checksum`: tool_checksum() of the parameters' tool. `node_id`: of the controller on the bus.
    WayOverBus(const Parameters<Scalar>& parameters, std::uint32_t checksum, std::uint8_t node_id);
    /// Another tool is in the spindle: its map is another.
    void change_tool(const AlongPath<Scalar>& along, std::uint32_t checksum);

    [[nodiscard]] std::uint32_t frame_id() const override { return way_window::way_frame_id(node_id_); }
    void on_frame(const hal::CanFrame& frame) override;
    void begin_again() override;
    [[nodiscard]] bool take_frame(hal::CanFrame& frame) override;

    void look_ahead(ForceControlTick<Scalar>& tick, const hal::ProgramStatus& program) override;
    /// For a tick of any kind.
    template <typename Tick>
    void look_ahead_of(Tick& tick, const hal::ProgramStatus& program) {
        go_to(program);
        control::WayAhead<Scalar> way = ahead_.step(along_.step(tick));
        way.known = way.known && !was_refuted_;
        tick.set_way_ahead(way);
    }

    [[nodiscard]] std::size_t room() const;
    /// Where the tool is along the path; nothing where it is not known.
    [[nodiscard]] std::optional<Scalar> position_mm() const;
    [[nodiscard]] bool is_refuted() const override { return was_refuted_ || ahead_.is_refuted(); }

  private:
    void go_to(const hal::ProgramStatus& program);
    void begin();
    void empty();
    bool take_record();
    [[nodiscard]] way_window::WayAnswer answer() const;

    std::uint8_t node_id_;
    control::FeedAheadSettings<Scalar> settings_;
    way_window::WayReceiver receiver_;
    AlongPath<Scalar> along_;
    PathPosition<Scalar> position_{};
    BlockWindow<Scalar> blocks_{};
    Ahead ahead_;
    int run_ = -1;              // none so far
    bool was_refuted_ = false;  // in an earlier session of this run
    bool is_asked_ = false;
};

extern template class WayOverBus<float>;
extern template class WayOverBus<estimation::Fixed>;

}  // namespace millforce::firmware
