// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace millforce::host {

/// Writes a file in the format MCAP (mcap.dev/spec), of JSON messages with JSON schemas: the subset that Foxglove and
/// PlotJuggler open with their index. Chunks are not compressed. What is written up to a crash is whole chunks, which
/// `mcap recover` makes a file of.
///
/// Errors of the stream are the caller's to look for. Not thread-safe.
class McapWriter {
  public:
    using Channel = std::uint16_t;

    /// `library`: the program that writes, with its version.
    McapWriter(std::ostream& out, std::string_view library);

    /// Before the first message. `schema`: a JSON schema, without which a reader shows no fields.
    [[nodiscard]] Channel add_channel(std::string_view topic, std::string_view schema_name, std::string_view schema);
    /// `time_ns`: since 1970, or since any moment that all messages share. `json`: one object.
    void add(Channel channel, std::uint64_t time_ns, std::string_view json);
    /// Writes what was added so far to the stream.
    void end_chunk();
    /// The last call.
    void finish();

  private:
    struct Entry {
        std::uint64_t time_ns;
        std::uint64_t offset;
    };
    struct ChunkIndex {
        std::uint64_t first_ns;
        std::uint64_t last_ns;
        std::uint64_t offset;
        std::uint64_t length;
        std::map<Channel, std::uint64_t> index_offsets;
        std::uint64_t index_length;
        std::uint64_t records_length;
    };

    void write(const std::string& bytes);
    void write_message_indexes(ChunkIndex& chunk);
    [[nodiscard]] std::string chunk_indexes() const;
    [[nodiscard]] std::string statistics() const;

    std::ostream& out_;
    std::uint64_t offset_ = 0;
    std::string schemas_{};   ///< records
    std::string channels_{};  ///< records
    std::map<Channel, std::uint64_t> counts_{};
    std::string chunk_{};  ///< records of the chunk that is not written yet
    std::map<Channel, std::vector<Entry>> entries_{};
    std::uint64_t first_ns_ = 0;
    std::uint64_t last_ns_ = 0;
    std::vector<ChunkIndex> chunks_{};
};

}  // namespace millforce::host
