// SPDX-License-Identifier: Apache-2.0
#include "mcap/mcap_writer.hpp"
#include "mcap/mcap_telemetry.hpp"

#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;

/// Reads what was written by the tables of the specification (mcap.dev/spec), and by nothing of the writer's.

namespace {

constexpr unsigned header = 0x01, footer = 0x02, schema = 0x03, channel = 0x04, message = 0x05, chunk = 0x06,
                   message_index = 0x07, chunk_index = 0x08, statistics = 0x0B, summary_offset = 0x0E, data_end = 0x0F;
const std::string magic("\x89MCAP0\r\n", 8);

class Bytes {
  public:
    explicit Bytes(std::string_view bytes) : bytes_(bytes) {}

    std::uint64_t number(std::size_t size) {
        std::uint64_t value = 0;
        for (std::size_t k = 0; k < size; ++k) {
            value |= std::uint64_t{static_cast<unsigned char>(bytes_.at(place_ + k))} << (8 * k);
        }
        place_ += size;
        return value;
    }
    std::string bytes(std::size_t size) {
        CHECK(place_ + size <= bytes_.size());
        place_ += size;
        return bytes_.substr(place_ - size, size);
    }
    std::string text() { return bytes(number(4)); }
    std::string rest() { return bytes(bytes_.size() - place_); }
    [[nodiscard]] bool is_at_end() const { return place_ == bytes_.size(); }
    [[nodiscard]] std::size_t place() const { return place_; }

  private:
    std::string bytes_;
    std::size_t place_ = 0;
};

struct Record {
    unsigned op;
    std::size_t begin;
    std::size_t length;  ///< with opcode and length
    std::string content;
};

std::vector<Record> records_of(std::string_view bytes, std::size_t begin = 0) {
    std::vector<Record> found;
    for (Bytes reader(bytes); !reader.is_at_end();) {
        const std::size_t place = reader.place();
        const auto op = static_cast<unsigned>(reader.number(1));
        const std::string content = reader.bytes(reader.number(8));
        found.push_back({op, begin + place, 9 + content.size(), content});
    }
    return found;
}

/// CRC-32 of ISO 3309, bit by bit from its definition.
std::uint32_t crc_of(std::string_view bytes) {
    std::uint32_t remainder = 0xFFFFFFFFU;
    for (const char byte : bytes) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            const std::uint32_t in = (static_cast<unsigned char>(byte) >> bit) & 1U;
            remainder = ((remainder ^ in) & 1U) != 0 ? (remainder >> 1U) ^ 0xEDB88320U : remainder >> 1U;
        }
    }
    return ~remainder;
}

}  // namespace

TEST_GROUP(McapWriter) {
    std::ostringstream out;

    std::vector<Record> file() {
        const std::string bytes = out.str();
        CHECK(bytes.starts_with(magic) && bytes.ends_with(magic));
        return records_of(std::string_view(bytes).substr(8, bytes.size() - 16), 8);
    }
    static std::vector<Record> all(const std::vector<Record>& records, unsigned op) {
        std::vector<Record> found;
        for (const Record& record : records) {
            if (record.op == op) {
                found.push_back(record);
            }
        }
        return found;
    }
    /// One channel with 10 000 messages in two chunks at least, and one with one.
    void write_two_channels() {
        McapWriter writer(out, "test");
        const auto one = writer.add_channel("/one", "One", R"({"type":"object"})");
        const auto two = writer.add_channel("/two", "Two", "{}");
        for (std::uint64_t k = 0; k < 10'000; ++k) {
            writer.add(one, 1'000'000 * k, R"({"value":)" + std::to_string(k) + std::string(50, ' ') + "}");
        }
        writer.add(two, 5, "{}");
        writer.finish();
    }
};

TEST(McapWriter, writes_the_records_in_the_order_of_the_specification) {
    write_two_channels();
    const auto records = file();
    UNSIGNED_LONGS_EQUAL(header, records.front().op);
    UNSIGNED_LONGS_EQUAL(footer, records.back().op);
    Bytes first(records.front().content);
    STRCMP_EQUAL("", first.text().c_str());
    STRCMP_EQUAL("test", first.text().c_str());
    Bytes channel_record(all(records, channel).at(0).content);
    UNSIGNED_LONGS_EQUAL(1, channel_record.number(2));
    UNSIGNED_LONGS_EQUAL(1, channel_record.number(2));
    STRCMP_EQUAL("/one", channel_record.text().c_str());
    STRCMP_EQUAL("json", channel_record.text().c_str());
    Bytes schema_record(all(records, schema).at(1).content);
    UNSIGNED_LONGS_EQUAL(2, schema_record.number(2));
    STRCMP_EQUAL("Two", schema_record.text().c_str());
    STRCMP_EQUAL("jsonschema", schema_record.text().c_str());
    STRCMP_EQUAL("{}", schema_record.text().c_str());
    UNSIGNED_LONGS_EQUAL(1, all(records, data_end).size());
}

TEST(McapWriter, keeps_every_message_in_a_chunk_with_its_time_and_number) {
    write_two_channels();
    std::uint64_t expected = 0;
    for (const Record& record : all(file(), chunk)) {
        Bytes reader(record.content);
        const std::uint64_t first_ns = reader.number(8);
        const std::uint64_t last_ns = reader.number(8);
        const std::uint64_t size = reader.number(8);
        const auto crc = static_cast<std::uint32_t>(reader.number(4));
        STRCMP_EQUAL("", reader.text().c_str());
        const std::string inside = reader.bytes(reader.number(8));
        UNSIGNED_LONGS_EQUAL(size, inside.size());
        UNSIGNED_LONGS_EQUAL(crc_of(inside), crc);
        for (const Record& each : records_of(inside)) {
            UNSIGNED_LONGS_EQUAL(message, each.op);
            Bytes fields(each.content);
            const bool is_first_channel = fields.number(2) == 1;
            const std::uint64_t sequence = fields.number(4);
            const std::uint64_t time_ns = fields.number(8);
            UNSIGNED_LONGS_EQUAL(time_ns, fields.number(8));
            CHECK(time_ns >= first_ns && time_ns <= last_ns);
            if (is_first_channel) {
                UNSIGNED_LONGS_EQUAL(expected, sequence);
                UNSIGNED_LONGS_EQUAL(1'000'000 * expected, time_ns);
                CHECK(fields.rest().starts_with(R"({"value":)" + std::to_string(expected)));
                ++expected;
            }
        }
    }
    UNSIGNED_LONGS_EQUAL(10'000, expected);
}

TEST(McapWriter, points_from_its_end_to_every_chunk_and_message) {
    write_two_channels();
    const std::string bytes = out.str();
    const auto records = file();
    Bytes end(records.back().content);
    const std::uint64_t summary_begin = end.number(8);
    const std::uint64_t offsets_begin = end.number(8);
    const auto crc = static_cast<std::uint32_t>(end.number(4));
    const std::size_t crc_place = records.back().begin + records.back().length - 4;
    UNSIGNED_LONGS_EQUAL(crc_of(std::string_view(bytes).substr(summary_begin, crc_place - summary_begin)), crc);
    UNSIGNED_LONGS_EQUAL(offsets_begin, all(records, summary_offset).front().begin);
    for (const Record& group : all(records, summary_offset)) {
        Bytes fields(group.content);
        const std::uint64_t op = fields.number(1);
        const std::uint64_t begin = fields.number(8);
        for (const Record& each : records_of(std::string_view(bytes).substr(begin, fields.number(8)))) {
            UNSIGNED_LONGS_EQUAL(op, each.op);
        }
    }
    const auto chunks = all(records, chunk);
    const auto indexes = all(records, chunk_index);
    CHECK(chunks.size() > 1);
    UNSIGNED_LONGS_EQUAL(chunks.size(), indexes.size());
    std::size_t messages = 0;
    for (std::size_t k = 0; k < chunks.size(); ++k) {
        Bytes fields(indexes[k].content);
        (void)fields.number(8);
        (void)fields.number(8);
        UNSIGNED_LONGS_EQUAL(chunks[k].begin, fields.number(8));
        UNSIGNED_LONGS_EQUAL(chunks[k].length, fields.number(8));
        const std::string places = fields.text();
        for (Bytes place(places); !place.is_at_end();) {
            const std::uint64_t id = place.number(2);
            const std::uint64_t offset = place.number(8);
            UNSIGNED_LONGS_EQUAL(message_index, static_cast<unsigned char>(bytes[offset]));
            Bytes index(std::string_view(bytes).substr(offset + 9));
            UNSIGNED_LONGS_EQUAL(id, index.number(2));
            messages += index.number(4) / 16;
        }
    }
    UNSIGNED_LONGS_EQUAL(10'001, messages);
    Bytes counted(all(records, statistics).at(0).content);
    UNSIGNED_LONGS_EQUAL(10'001, counted.number(8));
}

TEST(McapWriter, writes_a_whole_file_without_a_message) {
    {
        McapTelemetry telemetry(out);
        telemetry.finish();
    }
    const auto records = file();
    LONGS_EQUAL(0, all(records, chunk).size());
    LONGS_EQUAL(4, all(records, channel).size());  // two, and their copies
}
