// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "telemetry/event_watch.hpp"
#include "telemetry/telemetry.hpp"

/// What the web page is made of, without a network: its resources, and the messages that keep it up to date.

namespace millforce::host {

struct WebResource {
    std::string content_type;
    std::string body;
    unsigned status = 200;  ///< of HTTP
};

/// What a LoopbackServer shows.
class WebPages {
  public:
    virtual ~WebPages() = default;
    /// None: there is no such path.
    [[nodiscard]] virtual std::optional<WebResource> resource(std::string_view path) const = 0;
};

/// The files of the page and its data: `/`, `/fields.json`, `/telemetry.json` (503 before the first tick), `/metrics`
/// and what these load.
class LivePage final : public WebPages {
  public:
    explicit LivePage(const std::string& title);

    void take(const Telemetry& telemetry) { newest_ = telemetry; }
    [[nodiscard]] std::optional<WebResource> resource(std::string_view path) const override;

  private:
    std::string title_;
    std::optional<Telemetry> newest_{};
};

/// Messages of the stream `/events` (server-sent events), the newest of a minute: a page that is opened shows what was.
/// Each has a number; a reader that is too slow finds the oldest that is left.
class LiveMessages {
  public:
    /// A row each 20 ms, messages of rows each 0.1 s.
    void add(const Telemetry& telemetry);
    void add(const TelemetryEvent& event);
    /// After some seconds without another message: the readers must see that there is somebody.
    void add_sign_of_life();

    /// The message of this number, or the oldest after it; `number` is set to it. Null: not yet there.
    [[nodiscard]] const std::string* at(std::uint64_t& number) const;
    [[nodiscard]] std::uint64_t oldest() const { return first_; }

  private:
    void push(std::string message);

    std::deque<std::string> messages_{};
    std::uint64_t first_ = 0;
    std::string rows_{};
    std::uint64_t next_row_us_ = 0;
    std::uint64_t next_message_us_ = 0;
};

}  // namespace millforce::host
