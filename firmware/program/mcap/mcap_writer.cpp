// SPDX-License-Identifier: Apache-2.0
#include "mcap/mcap_writer.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "firmware/crc32.hpp"

namespace millforce::host {

namespace {

constexpr std::string_view magic("\x89MCAP0\r\n", 8);
constexpr std::size_t chunk_bytes = std::size_t{512} * 1024;

/// Numbers of the records in the specification.
enum class Op : std::uint8_t {
    header = 0x01,
    footer = 0x02,
    schema = 0x03,
    channel = 0x04,
    message = 0x05,
    chunk = 0x06,
    message_index = 0x07,
    chunk_index = 0x08,
    statistics = 0x0B,
    summary_offset = 0x0E,
    data_end = 0x0F,
};

/// Little endian.
template <typename Number>
void put(std::string& bytes, Number value) {
    for (std::size_t k = 0; k < sizeof value; ++k) {
        bytes += static_cast<char>((value >> (8U * k)) & 0xFFU);
    }
}

void put_text(std::string& bytes, std::string_view text) {
    put(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += text;
}

std::string record(Op op, std::string_view content) {
    std::string bytes(1, static_cast<char>(op));
    put(bytes, static_cast<std::uint64_t>(content.size()));
    bytes += content;
    return bytes;
}

std::uint32_t crc_of(std::string_view bytes) {
    return firmware::crc32(0, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

/// The groups of records at the file's end, each with its place.
class Summary {
  public:
    explicit Summary(std::uint64_t begin) : begin_(begin) {}

    void add(Op op, std::string_view records) {
        if (!records.empty()) {
            std::string place(1, static_cast<char>(op));
            put(place, begin_ + records_.size());
            put(place, static_cast<std::uint64_t>(records.size()));
            places_ += record(Op::summary_offset, place);
            records_ += records;
        }
    }
    /// With the footer.
    [[nodiscard]] std::string bytes() const {
        std::string footer;
        put(footer, begin_);
        put(footer, begin_ + records_.size());
        constexpr std::size_t crc_bytes = 4;
        std::string all = records_ + places_;
        all += static_cast<char>(Op::footer);
        put(all, static_cast<std::uint64_t>(footer.size() + crc_bytes));
        all += footer;
        put(all, crc_of(all));
        return all;
    }

  private:
    std::uint64_t begin_;
    std::string records_{};
    std::string places_{};
};

}  // namespace

McapWriter::McapWriter(std::ostream& out, std::string_view library) : out_(out) {
    std::string header;
    put_text(header, "");  // no profile
    put_text(header, library);
    write(std::string(magic));
    write(record(Op::header, header));
}

void McapWriter::write(const std::string& bytes) {
    out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    offset_ += bytes.size();
}

McapWriter::Channel McapWriter::add_channel(std::string_view topic, std::string_view schema_name,
                                            std::string_view schema) {
    const auto id = static_cast<Channel>(counts_.size() + 1);  // 0 is no schema
    counts_.emplace(id, 0);
    std::string content;
    put(content, id);
    put_text(content, schema_name);
    put_text(content, "jsonschema");
    put_text(content, schema);
    const std::string schema_record = record(Op::schema, content);
    content.clear();
    put(content, id);
    put(content, id);
    put_text(content, topic);
    put_text(content, "json");
    put_text(content, "");  // no metadata
    const std::string channel_record = record(Op::channel, content);
    schemas_ += schema_record;
    channels_ += channel_record;
    write(schema_record);
    write(channel_record);
    return id;
}

void McapWriter::add(Channel channel, std::uint64_t time_ns, std::string_view json) {
    std::uint64_t& count = counts_.at(channel);
    std::string content;
    put(content, channel);
    put(content, static_cast<std::uint32_t>(count));
    put(content, time_ns);
    put(content, time_ns);
    content += json;
    ++count;
    first_ns_ = chunk_.empty() ? time_ns : std::min(first_ns_, time_ns);
    last_ns_ = chunk_.empty() ? time_ns : std::max(last_ns_, time_ns);
    entries_[channel].push_back({time_ns, chunk_.size()});
    chunk_ += record(Op::message, content);
    if (chunk_.size() >= chunk_bytes) {
        end_chunk();
    }
}

void McapWriter::end_chunk() {
    if (chunk_.empty()) {
        return;
    }
    std::string content;
    put(content, first_ns_);
    put(content, last_ns_);
    put(content, static_cast<std::uint64_t>(chunk_.size()));
    put(content, crc_of(chunk_));
    put_text(content, "");  // not compressed
    put(content, static_cast<std::uint64_t>(chunk_.size()));
    content += chunk_;
    const std::string bytes = record(Op::chunk, content);
    ChunkIndex chunk{first_ns_, last_ns_, offset_, bytes.size(), {}, 0, chunk_.size()};
    write(bytes);
    write_message_indexes(chunk);
    chunks_.push_back(std::move(chunk));
    chunk_.clear();
    entries_.clear();
    out_.flush();
}

void McapWriter::write_message_indexes(ChunkIndex& chunk) {
    const std::uint64_t begin = offset_;
    for (const auto& [channel, entries] : entries_) {
        std::string places;
        for (const Entry& entry : entries) {
            put(places, entry.time_ns);
            put(places, entry.offset);
        }
        std::string content;
        put(content, channel);
        put_text(content, places);
        chunk.index_offsets.emplace(channel, offset_);
        write(record(Op::message_index, content));
    }
    chunk.index_length = offset_ - begin;
}

std::string McapWriter::chunk_indexes() const {
    std::string records;
    for (const ChunkIndex& chunk : chunks_) {
        std::string places;
        for (const auto& [channel, offset] : chunk.index_offsets) {
            put(places, channel);
            put(places, offset);
        }
        std::string content;
        put(content, chunk.first_ns);
        put(content, chunk.last_ns);
        put(content, chunk.offset);
        put(content, chunk.length);
        put_text(content, places);
        put(content, chunk.index_length);
        put_text(content, "");
        put(content, chunk.records_length);
        put(content, chunk.records_length);
        records += record(Op::chunk_index, content);
    }
    return records;
}

std::string McapWriter::statistics() const {
    std::uint64_t messages = 0;
    std::string counts;
    for (const auto& [channel, count] : counts_) {
        messages += count;
        put(counts, channel);
        put(counts, count);
    }
    std::uint64_t first_ns = chunks_.empty() ? 0 : chunks_.front().first_ns;
    std::uint64_t last_ns = 0;
    for (const ChunkIndex& chunk : chunks_) {
        first_ns = std::min(first_ns, chunk.first_ns);
        last_ns = std::max(last_ns, chunk.last_ns);
    }
    std::string content;
    put(content, messages);
    put(content, static_cast<std::uint16_t>(counts_.size()));
    put(content, static_cast<std::uint32_t>(counts_.size()));
    put(content, std::uint32_t{0});  // attachments
    put(content, std::uint32_t{0});  // metadata
    put(content, static_cast<std::uint32_t>(chunks_.size()));
    put(content, first_ns);
    put(content, last_ns);
    put_text(content, counts);
    return record(Op::statistics, content);
}

void McapWriter::finish() {
    end_chunk();
    std::string no_crc;
    put(no_crc, std::uint32_t{0});
    write(record(Op::data_end, no_crc));
    Summary summary(offset_);
    summary.add(Op::schema, schemas_);
    summary.add(Op::channel, channels_);
    summary.add(Op::chunk_index, chunk_indexes());
    summary.add(Op::statistics, statistics());
    write(summary.bytes());
    write(std::string(magic));
    out_.flush();
}

}  // namespace millforce::host
