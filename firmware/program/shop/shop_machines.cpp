// SPDX-License-Identifier: Apache-2.0
#include "shop/shop_machines.hpp"

#include "gateway/gateway_settings.hpp"

namespace millforce::host {

namespace {

void note(std::deque<std::string>& notes, std::string_view text) {
    notes.emplace_front(text);
    if (notes.size() > ShopMachines::most_notes) {
        notes.pop_back();
    }
}

void write_texts(JsonWriter& json, std::string_view key, const std::deque<std::string>& texts) {
    json.key(key).begin_array();
    for (const std::string& text : texts) {
        json.text(text);
    }
    json.end_array();
}

}  // namespace

void ShopMachines::take(std::string_view levels, std::string_view payload) {
    const std::size_t slash = levels.find('/');
    const std::string_view name = levels.substr(0, slash);
    if (slash == std::string_view::npos || !is_name_of_machine(name) || payload.size() > most_bytes) {
        return;
    }
    const std::string_view kind = levels.substr(slash + 1);
    const bool is_known_kind = kind == "online" || kind == "state" || kind == "event" || kind == "job";
    auto found = machines_.find(name);
    if (!is_known_kind || (found == machines_.end() && machines_.size() >= most_machines)) {
        return;
    }
    if (found == machines_.end()) {
        found = machines_.emplace(name, Machine{}).first;
    }
    Machine& machine = found->second;
    if (kind == "online") {
        machine.is_online = payload == "1";
    } else if (kind == "state") {
        machine.state = payload;
    } else {
        note(kind == "event" ? machine.events : machine.jobs, payload);
    }
}

void ShopMachines::write(JsonWriter& json) const {
    json.key("machines").begin_array();
    for (const auto& [name, machine] : machines_) {
        json.begin_object().key("name").text(name).key("is_online").boolean(machine.is_online);
        json.key("state").text(machine.state);
        write_texts(json, "events", machine.events);
        write_texts(json, "jobs", machine.jobs);
        json.end_object();
    }
    json.end_array();
}

}  // namespace millforce::host
