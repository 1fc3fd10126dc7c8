// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "hal/can_frame.hpp"
#include "part_map/path_position.hpp"
#include "part_map/way_records.hpp"
#include "program_status/position_frame.hpp"
#include "way_window/way_frames.hpp"

namespace millforce::host {

struct WaySenderSettings {
    std::uint8_t node_id = 0;              ///< of the controller
    std::uint32_t position_id = 0;         ///< of the CNC's position frame
    std::uint64_t frame_period_us = 1000;  ///< one frame in each: a quarter of a bus at 500 kbit/s
};

/// Hands a part map to a controller without files, as a window of records over the bus, without the bus: frames and
/// times in, frames to send out.
///
///     sender.on_frame(frame, time_us);                  // every frame of the bus
///     sender.poll(now_us);                              // each millisecond or so
///     while (sender.take_frame(frame)) { ... }          // send
///
/// Each ask is answered with the record that the controller expects next. What was sent before the ask and has not
/// arrived is sent again from there on. A session begins where the tool is: at the start, and where the controller has
/// none or has taken something else than what was sent; where it was left behind; and, as another run, where the
/// program has begun again. Not thread-safe.
class WaySender {
  public:
    WaySender(const WaySenderSettings& settings, const PartMap& map, const firmware::Parameters<float>& parameters);

    void on_frame(const hal::CanFrame& frame, std::uint64_t time_us);
    void poll(std::uint64_t now_us);
    [[nodiscard]] bool take_frame(hal::CanFrame& frame);
    /// Another tool was in the spindle meanwhile: a new run of the program, wherever it is.
    void begin_again(std::uint64_t now_us);

    /// What the controller says; nothing where it has been silent for half a second.
    [[nodiscard]] std::optional<way_window::WayState> controller_state(std::uint64_t now_us) const;
    /// Where the tool is, by the frames of the CNC.
    [[nodiscard]] std::optional<double> position_mm() const { return position_mm_; }
    /// Up to where the controller has the map.
    [[nodiscard]] double known_to_mm() const;
    [[nodiscard]] std::uint32_t sessions() const { return sessions_; }
    [[nodiscard]] std::size_t record_count() const { return records_.size(); }

  private:
    void take_position(std::uint64_t time_us);
    [[nodiscard]] bool is_of_use(const way_window::WayAnswer& answer);
    void take_answer(const way_window::WayAnswer& answer, std::uint64_t time_us);
    void begin(std::uint64_t now_us);
    [[nodiscard]] std::size_t first_record_at(double path_mm) const;
    [[nodiscard]] bool is_left_behind(std::uint64_t now_us) const;
    [[nodiscard]] bool is_refused() const;
    [[nodiscard]] bool is_accepted() const;
    void send_next(std::uint64_t now_us);
    void send_record();
    void go_back();
    void ask(std::uint64_t now_us);
    void push(const way_window::WayFrame& frame);

    WaySenderSettings settings_;
    std::vector<WayRecord> records_;
    std::uint32_t tool_checksum_;
    PathPosition position_;
    program_status::PositionReceiver position_receiver_;
    std::optional<double> position_mm_{};
    std::uint64_t position_us_ = 0;
    double reached_mm_ = 0.0;           // in this run
    std::uint64_t left_behind_us_ = 0;  // since when; 0: it is not

    std::deque<hal::CanFrame> frames_;  // of the record in work
    std::uint64_t paced_us_ = 0;        // up to when frames were let go
    std::uint64_t frames_due_ = 0;      // that may go
    std::uint8_t session_ = 0;
    std::uint8_t run_ = 0;
    std::uint32_t sessions_ = 0;
    std::size_t first_ = 0;     // record of the session
    std::size_t next_ = 0;      // to be sent
    std::size_t taken_ = 0;     // so many the controller has
    std::uint16_t digest_ = 0;  // of those
    std::size_t room_ = way_window::largest_window;
    std::uint64_t asks_ = 0;
    std::array<std::size_t, 256> next_at_ask_{};  // by an ask's number
    std::uint64_t answered_ask_ = 0;
    std::uint64_t valid_from_ask_ = 0;  // since the sender went back
    std::uint64_t ask_us_ = 0;
    std::uint64_t begun_us_ = 0;  // the session
    std::optional<way_window::WayAnswer> answer_{};
    std::uint64_t answer_us_ = 0;
};

}  // namespace millforce::host
