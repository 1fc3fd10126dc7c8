// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "live/view_text.hpp"
#include "telemetry/telemetry_hub.hpp"

namespace millforce::host {

/// The telemetry on the terminal, drawn in place four times a second while the program is in the foreground. Lines of
/// standard error appear among the events, and are printed when the view has ended, as without it. One at a time.
class TerminalView final : public TelemetrySink {
  public:
    /// Throws InputError where standard output is no terminal, or one that cannot be drawn on.
    explicit TerminalView(const std::string& title);
    /// The terminal is as it was before.
    ~TerminalView() override;
    TerminalView(const TerminalView&) = delete;
    TerminalView& operator=(const TerminalView&) = delete;

    void on_sample(const Telemetry& telemetry) override { state_.take(telemetry); }
    void on_event(const TelemetryEvent& event) override { state_.add_event(event.unix_us, event.text); }
    void on_turn() override;

  private:
    void capture_errors();
    void read_errors();
    void draw();
    [[nodiscard]] ViewSize size() const;

    ViewState state_{};
    int terminal_ = -1;
    int errors_ = -1;       ///< what is written to standard error comes out here; -1: it is no terminal
    int true_errors_ = -1;  ///< standard error as it was
    std::string error_line_{};
    std::vector<std::string> error_lines_{};
    bool has_unicode_ = false;
    std::uint64_t drawn_us_ = 0;
    ViewSize drawn_size_{};
};

}  // namespace millforce::host
