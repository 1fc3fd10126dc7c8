// SPDX-License-Identifier: Apache-2.0
#include "mcap/mcap_telemetry.hpp"

#include <fmt/format.h>

#include "report/json_writer.hpp"
#include "telemetry/telemetry_fields.hpp"

namespace millforce::host {

namespace {

const char* type_of(FieldKind kind) {
    switch (kind) {
        case FieldKind::number:
            return "number";
        case FieldKind::count:
        case FieldKind::counter:
            return "integer";
        case FieldKind::flag:
            return "boolean";
        case FieldKind::word:
            return "string";
        case FieldKind::words:
            return "array";
    }
    return "string";
}

std::string fields_schema() {
    JsonWriter json;
    json.begin_object().key("title").text("millforce.Telemetry").key("type").text("object").key("properties");
    json.begin_object();
    for (const TelemetryField& field : telemetry_fields()) {
        json.key(field.name).begin_object().key("type").text(type_of(field.kind));
        if (field.kind == FieldKind::words) {
            json.key("items").begin_object().key("type").text("string").end_object();
        }
        json.key("description").text(field.meaning).end_object();
    }
    return json.end_object().end_object().str();
}

/// As published for `foxglove.Log`.
constexpr std::string_view log_schema =
    R"({"title":"foxglove.Log","type":"object","properties":{)"
    R"("timestamp":{"type":"object","title":"time","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},)"
    R"("level":{"type":"integer"},"message":{"type":"string"},"name":{"type":"string"},)"
    R"("file":{"type":"string"},"line":{"type":"integer"}}})";

/// Of foxglove.Log.
int number_of(EventLevel level) {
    constexpr int info = 2;
    constexpr int warning = 3;
    constexpr int error = 4;
    return level == EventLevel::fault ? error : level == EventLevel::warning ? warning : info;
}

std::uint64_t in_ns(std::uint64_t time_us) {
    return 1000 * time_us;
}

}  // namespace

McapTelemetry::McapTelemetry(std::ostream& out)
    : writer_(out, "millforce"),
      fields_(writer_.add_channel("/millforce", "millforce.Telemetry", fields_schema())),
      log_(writer_.add_channel("/log", "foxglove.Log", log_schema)) {}

void McapTelemetry::add(const Telemetry& telemetry) {
    writer_.add(fields_, in_ns(telemetry.unix_us), telemetry_json(telemetry));
}

void McapTelemetry::add(const TelemetryEvent& event) {
    JsonWriter json;
    json.begin_object().key("timestamp").begin_object();
    json.key("sec").unsigned_integer(event.unix_us / 1'000'000);
    json.key("nsec").unsigned_integer(in_ns(event.unix_us % 1'000'000)).end_object();
    json.key("level").integer(number_of(event.level)).key("message").text(event.text).key("name").text("millforce");
    json.key("file").text("").key("line").integer(0).end_object();
    writer_.add(log_, in_ns(event.unix_us), json.str());
}

}  // namespace millforce::host
