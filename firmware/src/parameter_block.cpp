// SPDX-License-Identifier: Apache-2.0
#include "firmware/parameter_block.hpp"
#include "firmware/crc32.hpp"
#include "firmware/parameters_in.hpp"

#include <bit>
#include <type_traits>

namespace millforce::firmware {

namespace {

void put(std::span<std::uint8_t> bytes, std::size_t offset, std::uint32_t value) {
    for (unsigned k = 0; k < 4U; ++k) {
        bytes[offset + k] = static_cast<std::uint8_t>(value >> (8U * k));
    }
}

std::uint32_t get(std::span<const std::uint8_t> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (unsigned k = 0; k < 4U; ++k) {
        value |= static_cast<std::uint32_t>(bytes[offset + k]) << (8U * k);
    }
    return value;
}

/// Takes the values of a block one by one.
class ValueReader {
  public:
    explicit ValueReader(std::span<const std::uint8_t> values) : values_(values) {}

    [[nodiscard]] bool all_in_range() const { return all_in_range_; }

    template <typename Field>
    void read(Field& field, float minimum, float maximum) {
        const float value = next();
        const bool is_in_range = value >= minimum && value <= maximum;  // not so NaN
        if (is_in_range && (std::is_floating_point_v<Field> || is_whole(value))) {
            field = field_of<Field>(value);
        } else {
            all_in_range_ = false;
        }
    }

  private:
    float next() {
        const auto value = std::bit_cast<float>(get(values_, 0));
        values_ = values_.subspan(4);
        return value;
    }
    static bool is_whole(float value) { return static_cast<float>(static_cast<std::uint32_t>(value)) == value; }

    std::span<const std::uint8_t> values_;
    bool all_in_range_ = true;
};

}  // namespace

ParameterBlock encoded(const Parameters<float>& parameters, std::uint32_t sequence) {
    ParameterBlock block{};
    std::size_t offset = block_header_bytes;
    for (const float value : values_of(parameters)) {
        put(block, offset, std::bit_cast<std::uint32_t>(value));
        offset += 4;
    }
    const std::span<const std::uint8_t> bytes(block);
    put(block, 0, block_magic);
    put(block, 4, table_fingerprint);
    put(block, 8, sequence);
    put(block, 12, static_cast<std::uint32_t>(4 * parameter_count));
    put(block, 16, crc32(0, bytes.subspan(block_header_bytes)));
    put(block, 20, crc32(0, bytes.first(20)));
    return block;
}

BlockError check_block(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < block_bytes || get(bytes, 0) != block_magic) {
        return BlockError::empty;
    }
    if (get(bytes, 20) != crc32(0, bytes.first(20))) {
        return BlockError::bad_header;
    }
    if (get(bytes, 4) != table_fingerprint) {
        return BlockError::other_table;
    }
    const bool values_are_whole = get(bytes, 12) == 4 * parameter_count &&
                                  get(bytes, 16) == crc32(0, bytes.subspan(block_header_bytes, 4 * parameter_count));
    return values_are_whole ? BlockError::none : BlockError::bad_values;
}

std::uint32_t sequence_of(std::span<const std::uint8_t> block) {
    return get(block, 8);
}

BlockError decode(std::span<const std::uint8_t> bytes, Parameters<float>& parameters) {
    const BlockError error = check_block(bytes);
    if (error != BlockError::none) {
        return error;
    }
    Parameters<float> read;
    ValueReader reader(bytes.subspan(block_header_bytes, 4 * parameter_count));
    for_each_parameter(read, [&reader](const ParameterName& /*name*/, auto& field, float minimum, float maximum) {
        reader.read(field, minimum, maximum);
    });
    if (!reader.all_in_range()) {
        return BlockError::out_of_range;
    }
    parameters = read;
    return BlockError::none;
}

}  // namespace millforce::firmware
