#pragma once

#include <concepts>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace voxlist::foreign {

/// What kind of record it is: the byte before its length.
enum class Op : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// How a file begins and ends.
inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

/// Appends a number, little-endian.
template <std::unsigned_integral T>
void put(T value, std::string& to) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    to += static_cast<char>((static_cast<std::uint64_t>(value) >> (8 * i)) & 0xFF);
}

/// Appends the length (uint32) and the bytes.
void put_text(std::string_view text, std::string& to);

/// Appends the length (uint64) and the bytes.
void put_bytes(std::string_view bytes, std::string& to);

/// Appends a whole record.
void put_record(Op op, std::string_view content, std::string& to);

/// What the messages of a channel are made of.
struct McapSchema {
  /// The type's name, such as foxglove.PointCloud.
  std::string name;
  /// How `data` is encoded, such as protobuf.
  std::string encoding;
  /// The type's definition.
  std::string data;
};

/// One stream of messages.
struct McapChannel {
  std::uint16_t schema = 0;  ///< number of its schema; 0: none
  std::string topic;
  /// How its messages are encoded, such as protobuf.
  std::string encoding;
};

std::string content_of(std::uint16_t id, const McapSchema& schema);
std::string content_of(std::uint16_t id, const McapChannel& channel);

/// The checksum that MCAP has everywhere, of `bytes` after those that gave `before`.
std::uint32_t crc_of(std::string_view bytes, std::uint32_t before = 0);

}  // namespace voxlist::foreign
