// SPDX-License-Identifier: Apache-2.0
#include "shop/shop.hpp"

#include <fmt/format.h>

#include <chrono>

#include "files/console.hpp"
#include "files/printable.hpp"
#include "live/live_assets.hpp"
#include "report/json_writer.hpp"
#include "report/page_assets.hpp"
#include "report/page_parts.hpp"
#include "report/page_template.hpp"
#include "shop/shop_assets.hpp"

namespace millforce::host {

namespace {

constexpr int turn_ms = 20;

double unix_now_s() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

Shop::Shop(const ShopSettings& settings, std::uint16_t port)
    : settings_(settings), client_(settings.broker, "", "", *this), server_(port, *this, nullptr) {}

void Shop::run(const std::atomic<bool>& stop) {
    server_.start();
    while (!stop.load()) {
        client_.turn(turn_ms);
        server_.turn();
    }
    client_.disconnect();
}

void Shop::on_connected() {
    trouble_.clear();
    client_.subscribe(settings_.topic + "/+/+");
    print_line(stderr, fmt::format("millforce: {}:{}: connected", settings_.broker.host, settings_.broker.port));
}

void Shop::on_disconnected(std::string_view reason) {
    if (trouble_ != reason) {
        trouble_ = reason;
        print_line(stderr,
                   "millforce: " + without_controls(fmt::format("{}:{}: {}: trying again", settings_.broker.host,
                                                                settings_.broker.port, reason)));
    }
}

void Shop::on_message(std::string_view topic, std::string_view payload) {
    const std::string prefix = settings_.topic + "/";
    if (topic.starts_with(prefix)) {
        machines_.take(topic.substr(prefix.size()), payload);
    }
}

std::string Shop::shop_json() const {
    JsonWriter json;
    json.begin_object().key("unix_s").decimal(unix_now_s(), 1);
    json.key("broker").text(fmt::format("{}:{}", settings_.broker.host, settings_.broker.port));
    json.key("trouble").text(trouble_);
    machines_.write(json);
    return json.end_object().str();
}

std::optional<WebResource> Shop::resource(std::string_view path) const {
    if (path == "/") {
        return WebResource{"text/html; charset=utf-8",
                           filled(shop_assets::shop_page(), {{"head", served_page_head("Machines", {"shop.css"})}})};
    }
    if (path == "/shop.css") {
        return WebResource{"text/css; charset=utf-8",
                           fmt::format("{}\n{}", page_assets::report_style(), shop_assets::shop_style())};
    }
    if (path == "/elements.js") {
        return WebResource{"text/javascript; charset=utf-8", std::string(live_assets::elements_script())};
    }
    if (path == "/shop.js") {
        return WebResource{"text/javascript; charset=utf-8", std::string(shop_assets::shop_script())};
    }
    if (path == "/shop.json") {
        return WebResource{"application/json", shop_json()};
    }
    return std::nullopt;
}

}  // namespace millforce::host
