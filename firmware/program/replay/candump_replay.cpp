// SPDX-License-Identifier: Apache-2.0
#include "replay/candump_replay.hpp"

#include <fmt/format.h>

#include <set>

#include "candump/log_line.hpp"
#include "cia402/objects.hpp"
#include "files/input_error.hpp"
#include "files/printable.hpp"
#include "files/text_lines.hpp"
#include "run_log/bus_names.hpp"
#include "run_log/local_line.hpp"

namespace millforce::host {

namespace {

/// The lines of a log, with errors that name their place.
class CandumpLines {
  public:
    explicit CandumpLines(const std::string& file) : lines_(file) {}

    bool next() {
        if (!lines_.next()) {
            return false;
        }
        const std::string& text = lines_.text();
        is_local_ = is_local_line(text);
        line_ = is_local_ ? candump::LogLine{.kind = candump::LineKind::blank} : candump::read_line(text);
        if (is_local_ && !read_local_line(text, beside_bus_)) {
            lines_.fail(fmt::format("'{}', expected a line as 'millforce run --record' writes it", printable(text)));
        }
        if (line_.kind == candump::LineKind::malformed) {
            throw InputError(fmt::format("{}:{}: '{}', {}", lines_.place(), line_.column, printable(text),
                                         candump::expectation(line_.error)));
        }
        return true;
    }
    [[nodiscard]] const candump::LogLine& line() const { return line_; }
    /// The line is no frame: it holds the values of a source beside the bus.
    [[nodiscard]] bool is_local() const { return is_local_; }
    [[nodiscard]] const hal::DriveSample& beside_bus() const { return beside_bus_; }
    [[nodiscard]] double fraction_read() const { return lines_.fraction_read(); }

  private:
    TextLines lines_;
    candump::LogLine line_{};
    bool is_local_ = false;
    hal::DriveSample beside_bus_{};
};

std::string list_of(const std::set<std::string, std::less<>>& names) {
    return name_list({names.begin(), names.end()});
}

}  // namespace

class CandumpReplay::Listener final : public firmware::TickListener {
  public:
    Listener(const std::function<void(const firmware::CanController&)>& act, std::uint64_t& ticks)
        : act_(act), ticks_(ticks) {}
    void on_tick(const firmware::CanController& controller) override {
        ++ticks_;
        act_(controller);
    }

  private:
    const std::function<void(const firmware::CanController&)>& act_;
    std::uint64_t& ticks_;
};

CandumpReplay::CandumpReplay(const Settings& settings) : settings_(settings) {
    survey();
    if (!has_start_) {
        take_rated_values();
    }
}

void CandumpReplay::survey() {
    CandumpLines lines(settings_.log);
    std::set<std::string, std::less<>> interfaces;
    while (lines.next()) {
        const candump::LogLine& line = lines.line();
        if (line.kind == candump::LineKind::blank) {
            continue;
        }
        if (!interfaces.contains(line.interface)) {
            interfaces.emplace(line.interface);
        }
        const bool is_asked = settings_.interface.empty() || line.interface == settings_.interface;
        if (line.kind == candump::LineKind::frame && is_asked) {
            has_start_ = has_start_ || is_start(line.frame);
            note_rated_value(line.frame);
        }
    }
    if (interfaces.empty()) {
        throw InputError(fmt::format("{}: no frames, expected a candump log", settings_.log));
    }
    if (settings_.interface.empty() && interfaces.size() > 1) {
        throw InputError(fmt::format("{}: frames of {}; expected one interface, or --interface", settings_.log,
                                     list_of(interfaces)));
    }
    if (!settings_.interface.empty() && !interfaces.contains(settings_.interface)) {
        throw InputError(fmt::format("--interface: '{}' is not in {}; expected one of {}", settings_.interface,
                                     settings_.log, list_of(interfaces)));
    }
}

bool CandumpReplay::is_start(const hal::CanFrame& frame) const {
    return override_frame::is_boot_up(frame, settings_.bus.feed_override.node_id);
}

/// An SDO answer with four bytes: 43 75 60 00 and the value.
void CandumpReplay::note_rated_value(const hal::CanFrame& frame) {
    if (frame.extended || frame.remote || frame.length != 8 || (frame.data[0] & 0xE3U) != 0x43U) {
        return;
    }
    for (std::size_t role = 0; role < cia402::drive_capacity; ++role) {
        const std::uint8_t node = settings_.bus.drives.drives[role].node_id;
        if (node == 0 || frame.id != cia402::cob_id::sdo_response + node) {
            continue;
        }
        const auto index = static_cast<std::uint16_t>(frame.data[1] | (frame.data[2] << 8U));
        const std::uint32_t value = static_cast<std::uint32_t>(frame.data[4]) | (std::uint32_t{frame.data[5]} << 8U) |
                                    (std::uint32_t{frame.data[6]} << 16U) | (std::uint32_t{frame.data[7]} << 24U);
        if (index == cia402::object::rated_current_mA) {
            rated_current_mA_[role] = value;
        } else if (index == cia402::object::rated_torque_mNm) {
            rated_torque_mNm_[role] = value;
        }
    }
}

void CandumpReplay::take_rated_values() {
    settings_.bus.drives.is_master = false;
    for (std::size_t role = 0; role < cia402::drive_capacity; ++role) {
        cia402::DriveSettings& drive = settings_.bus.drives.drives[role];
        const bool by_torque = drive.current_source == cia402::CurrentSource::torque;
        float& rated = by_torque ? drive.rated_torque_Nm : drive.rated_current_A;
        const std::uint32_t answered = by_torque ? rated_torque_mNm_[role] : rated_current_mA_[role];
        if (drive.node_id == 0 || !drive.gives_current || rated > 0.0F) {
            continue;
        }
        if (answered == 0) {
            throw InputError(
                fmt::format("{}: no drive's answer gives the rated value of {}; expected it in the machine's file ({})",
                            settings_.log, drive_names[role], by_torque ? "rated_torque_Nm" : "rated_current_A"));
        }
        rated = static_cast<float>(answered) * 0.001F;
    }
}

void CandumpReplay::run(const std::function<void(const firmware::CanController&)>& on_tick,
                        const std::function<void(double share)>& progress) {
    Listener listener(on_tick, ticks_);
    CandumpLines lines(settings_.log);
    firmware::CanControllerSettings settings;
    settings.drives = settings_.bus.drives;  // produces_sync stays false: every SYNC of the log counts
    settings.feed_override = settings_.bus.feed_override;
    settings.program = settings_.bus.program;
    settings.begins_at_once = !has_start_;
    BusClock clock(settings_.time);
    controller_ = std::make_unique<firmware::CanController>(settings, settings_.parameters, &listener, settings_.tools,
                                                            settings_.way);
    while (lines.next()) {
        const candump::LogLine& line = lines.line();
        if (lines.is_local()) {
            controller_->add(lines.beside_bus());
        }
        const bool is_asked = settings_.interface.empty() || line.interface == settings_.interface;
        if (line.kind == candump::LineKind::blank || !is_asked) {
            continue;
        }
        if (line.kind != candump::LineKind::frame) {
            ++not_used_;
            continue;
        }
        ++frames_;
        clock.on_frame(line.frame);
        if (is_start(line.frame)) {
            clock.begin();
        }
        controller_->on_frame(line.frame, clock.of_unix(line.time_us), is_start(line.frame));
        // What it would send was sent during the run.
        hal::CanFrame sent;
        while (controller_->take_frame(sent)) {
        }
        if (frames_ % 4096 == 0) {
            progress(lines.fraction_read());
        }
    }
}

}  // namespace millforce::host
