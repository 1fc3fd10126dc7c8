// SPDX-License-Identifier: Apache-2.0
#include "live/live_page.hpp"

#include <fmt/format.h>

#include <utility>

#include "files/printable.hpp"
#include "live/live_assets.hpp"
#include "report/json_writer.hpp"
#include "report/page_assets.hpp"
#include "report/page_parts.hpp"
#include "report/page_template.hpp"
#include "telemetry/prometheus.hpp"
#include "telemetry/telemetry_fields.hpp"

namespace millforce::host {

namespace {

constexpr std::uint64_t row_period_us = 20'000;
constexpr std::uint64_t message_period_us = 100'000;
constexpr std::size_t most_messages = 650;  // a minute of rows, and some events

std::string fields_json(const std::string& title) {
    JsonWriter json;
    json.begin_object().key("title").text(title).key("fields").begin_array();
    for (const TelemetryField& field : telemetry_fields()) {
        json.begin_object()
            .key("name")
            .text(field.name)
            .key("unit")
            .text(field.unit)
            .key("meaning")
            .text(field.meaning);
        json.end_object();
    }
    return json.end_array().end_object().str();
}

/// Unix time in ms, then the fields in their order.
std::string row_json(const Telemetry& telemetry) {
    std::string text = fmt::format("[{}", telemetry.unix_us / 1000);
    for (const TelemetryField& field : telemetry_fields()) {
        const std::string value = json_value(field.value(telemetry));
        text += ',';
        text += value.empty() ? "null" : value;
    }
    return text + ']';
}

std::optional<WebResource> file_of_page(std::string_view path) {
    if (path == "/live.css") {
        return WebResource{"text/css; charset=utf-8",
                           fmt::format("{}\n{}", page_assets::report_style(), live_assets::live_style())};
    }
    if (path == "/elements.js") {
        return WebResource{"text/javascript; charset=utf-8", std::string(live_assets::elements_script())};
    }
    if (path == "/live.js") {
        return WebResource{"text/javascript; charset=utf-8", std::string(live_assets::live_script())};
    }
    if (path == "/dygraph.css") {
        return WebResource{"text/css; charset=utf-8", std::string(without_source_map(page_assets::dygraphs_style()))};
    }
    if (path == "/dygraph.js") {
        return WebResource{"text/javascript; charset=utf-8",
                           std::string(without_source_map(page_assets::dygraphs_script()))};
    }
    return std::nullopt;
}

}  // namespace

LivePage::LivePage(const std::string& title) : title_(printable(title)) {}

std::optional<WebResource> LivePage::resource(std::string_view path) const {
    if (path == "/") {
        const std::string title = html_escaped(title_);
        const std::string head = served_page_head(title, {"dygraph.css", "live.css"});
        return WebResource{"text/html; charset=utf-8",
                           filled(live_assets::live_template(), {{"head", head}, {"title", title}})};
    }
    if (path == "/fields.json") {
        return WebResource{"application/json", fields_json(title_)};
    }
    if (path == "/telemetry.json") {
        constexpr unsigned service_unavailable = 503;
        return newest_ ? WebResource{"application/json", telemetry_json(*newest_)}
                       : WebResource{"text/plain; charset=utf-8", "no tick yet\n", service_unavailable};
    }
    if (path == "/metrics") {
        return WebResource{"text/plain; version=0.0.4; charset=utf-8",
                           newest_ ? prometheus_text(*newest_) : std::string()};
    }
    return file_of_page(path);
}

void LiveMessages::push(std::string message) {
    messages_.push_back(std::move(message));
    if (messages_.size() > most_messages) {
        messages_.pop_front();
        ++first_;
    }
}

void LiveMessages::add(const Telemetry& telemetry) {
    if (telemetry.unix_us < next_row_us_) {
        return;
    }
    next_row_us_ = telemetry.unix_us + row_period_us;
    rows_ += (rows_.empty() ? "" : ",") + row_json(telemetry);
    if (telemetry.unix_us >= next_message_us_) {
        next_message_us_ = telemetry.unix_us + message_period_us;
        push(fmt::format("event: rows\ndata: [{}]\n\n", std::exchange(rows_, {})));
    }
}

void LiveMessages::add(const TelemetryEvent& event) {
    JsonWriter json;
    json.begin_object().key("unix_ms").unsigned_integer(event.unix_us / 1000).key("level").text(name(event.level));
    json.key("text").text(event.text).end_object();
    push(fmt::format("event: event\ndata: {}\n\n", json.str()));
}

void LiveMessages::add_sign_of_life() {
    push(": no tick\n\n");
}

const std::string* LiveMessages::at(std::uint64_t& number) const {
    number = std::max(number, first_);
    const std::uint64_t place = number - first_;
    return place < messages_.size() ? &messages_[place] : nullptr;
}

}  // namespace millforce::host
