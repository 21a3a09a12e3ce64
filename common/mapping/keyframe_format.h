#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "voxlist/mapping/map_builder.h"

/// The bytes of a keyframe file, all little-endian.
///
///     file    "VOXKF002", map id (int64), checksum of both (uint32), 4 bytes of 0; then records
///     record  sync word (4 bytes), kind, payload's bytes, number (uint32 each), map id (int64),
///             checksum of the payload, checksum of this header (uint32 each); then the payload
///     payload utime in us (int64), T_map_base (12 doubles, row-major 3 x 4), points and origins
///             (uint32 each), then their coordinates in m (3 float32 each)
///
/// A record of kind 2 says that keyframes were moved since they came: the graph beside the file
/// (graph/stored_graph.h) tells where they are. Its payload is how often they were (int64).
///
/// Checksums are zlib's CRC-32. A record stands for itself: it has its own sync word, so that it is
/// found after any damage, and the map's id, so that the file's header can be lost.
///
/// Files of the first format ("VOXKF001", map id, records of payload's bytes, payload's checksum,
/// payload) are read; records of today's format are appended to them.
namespace voxlist::mapping {

inline constexpr std::size_t kFileHeaderBytes = 24;
inline constexpr std::string_view kSync = "\xF5VXK";

/// Bytes from its start on with which a record can be told from anything else.
inline constexpr std::size_t kRecordStartBytes = 120;

std::string file_header(std::int64_t map_id);

/// What a whole file header says.
struct FileHeader {
  std::int64_t map_id = 0;
  std::size_t bytes = kFileHeaderBytes;
  /// Whether the file was begun in the first format, whose header has no checksum.
  bool first_format = false;
};

/// The header that a file's first bytes are; nothing when they are damaged, or of another file.
std::optional<FileHeader> parse_file_header(std::string_view bytes);

/// The header that a first-format file whose magic is damaged must have had.
FileHeader first_format_header(std::string_view bytes);

/// What a record's header says.
struct RecordHeader {
  static constexpr std::uint32_t kKeyframe = 1, kMoved = 2;

  std::uint32_t kind = kKeyframe;
  std::uint32_t payload_bytes = 0;
  /// Counts a file's records, so that one that was written twice is known. 0 in the first format.
  std::uint32_t number = 0;
  /// Nothing in the first format.
  std::optional<std::int64_t> map_id;
  std::uint32_t payload_checksum = 0;
  /// Bytes of the header itself.
  std::size_t bytes = 0;
};

/// The header at the start of `bytes`, of which kRecordStartBytes are enough; nothing when there is
/// none, or it is damaged.
std::optional<RecordHeader> parse_record_header(std::string_view bytes);
std::optional<RecordHeader> parse_first_format_record(std::string_view bytes);

std::uint32_t checksum_of(std::string_view bytes);

/// The whole record of a keyframe.
std::string encode_record(const Keyframe& keyframe, std::int64_t map_id, std::uint32_t number);

/// The whole record that says that keyframes were moved.
std::string encode_moved(std::int64_t moves, std::int64_t map_id, std::uint32_t number);

/// The keyframe in a payload; nothing when its lengths do not fit together, or its pose is no pose.
std::optional<Keyframe> decode_payload(std::string_view payload);

}  // namespace voxlist::mapping
