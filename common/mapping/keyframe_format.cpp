#include "voxlist/mapping/keyframe_format.h"

#include <zlib.h>

#include <bit>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

static_assert(std::endian::native == std::endian::little,
              "the keyframe file is written as memory lies");

namespace voxlist::mapping {
namespace {

constexpr std::string_view kMagic = "VOXKF002";
constexpr std::string_view kFirstMagic = "VOXKF001";
constexpr std::size_t kFirstHeaderBytes = 16;
constexpr std::size_t kFirstRecordHeaderBytes = 8;
constexpr std::size_t kRecordHeaderBytes = 32;
constexpr std::size_t kPayloadHeader =
    sizeof(std::int64_t) + 12 * sizeof(double) + 2 * sizeof(std::uint32_t);
constexpr std::size_t kPoint = 3 * sizeof(float);
static_assert(kRecordStartBytes >= kFirstRecordHeaderBytes + kPayloadHeader);

template <class T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put(std::string& bytes, const std::vector<Eigen::Vector3f>& points) {
  for (const auto& p : points) bytes.append(reinterpret_cast<const char*>(p.data()), kPoint);
}

template <class T>
T take(std::string_view& bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return value;
}

std::vector<Eigen::Vector3f> take_points(std::string_view& bytes, std::size_t count) {
  std::vector<Eigen::Vector3f> points(count);
  for (auto& p : points) {
    std::memcpy(p.data(), bytes.data(), kPoint);
    bytes.remove_prefix(kPoint);
  }
  return points;
}

struct Counts {
  std::size_t points = 0;
  std::size_t origins = 0;
};

// Takes off the two counts; nothing when they are not those of a payload of `payload_bytes`.
std::optional<Counts> take_counts(std::string_view& bytes, std::size_t payload_bytes) {
  Counts counts;
  counts.points = take<std::uint32_t>(bytes);
  counts.origins = take<std::uint32_t>(bytes);
  const bool fit = payload_bytes == kPayloadHeader + (counts.points + counts.origins) * kPoint &&
                   (counts.origins == 0 || counts.origins == counts.points);
  return fit ? std::optional(counts) : std::nullopt;
}

std::string encode_payload(const Keyframe& keyframe) {
  std::string payload;
  payload.reserve(kPayloadHeader +
                  (keyframe.cloud.points.size() + keyframe.cloud.origins.size()) * kPoint);
  put(payload, keyframe.cloud.utime_us);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) put(payload, keyframe.T_map_base(row, column));
  }
  put(payload, static_cast<std::uint32_t>(keyframe.cloud.points.size()));
  put(payload, static_cast<std::uint32_t>(keyframe.cloud.origins.size()));
  put(payload, keyframe.cloud.points);
  put(payload, keyframe.cloud.origins);
  if (payload.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::length_error("a cloud of more than 4 GiB is no keyframe");
  }
  return payload;
}

}  // namespace

std::uint32_t checksum_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string file_header(std::int64_t map_id) {
  std::string bytes(kMagic);
  put(bytes, map_id);
  put(bytes, checksum_of(bytes));
  put(bytes, std::uint32_t{0});
  return bytes;
}

std::optional<FileHeader> parse_file_header(std::string_view bytes) {
  if (bytes.size() >= kFirstHeaderBytes && bytes.starts_with(kFirstMagic))
    return first_format_header(bytes);
  if (bytes.size() < kFileHeaderBytes) return std::nullopt;
  std::string_view id = bytes.substr(kMagic.size());
  const FileHeader header{take<std::int64_t>(id), kFileHeaderBytes, false};
  const bool whole = bytes.starts_with(file_header(header.map_id));
  return whole ? std::optional(header) : std::nullopt;
}

FileHeader first_format_header(std::string_view bytes) {
  bytes.remove_prefix(kFirstMagic.size());
  return {take<std::int64_t>(bytes), kFirstHeaderBytes, true};
}

std::optional<RecordHeader> parse_record_header(std::string_view bytes) {
  if (bytes.size() < kRecordHeaderBytes || !bytes.starts_with(kSync)) return std::nullopt;
  constexpr std::size_t kChecked = kRecordHeaderBytes - sizeof(std::uint32_t);
  const std::uint32_t checksum = checksum_of(bytes.substr(0, kChecked));
  bytes.remove_prefix(kSync.size());
  RecordHeader header;
  header.kind = take<std::uint32_t>(bytes);
  header.payload_bytes = take<std::uint32_t>(bytes);
  header.number = take<std::uint32_t>(bytes);
  header.map_id = take<std::int64_t>(bytes);
  header.payload_checksum = take<std::uint32_t>(bytes);
  header.bytes = kRecordHeaderBytes;
  return take<std::uint32_t>(bytes) == checksum ? std::optional(header) : std::nullopt;
}

// Its header has no checksum, so the payload's counts must agree with its length.
std::optional<RecordHeader> parse_first_format_record(std::string_view bytes) {
  if (bytes.size() < kFirstRecordHeaderBytes + kPayloadHeader) return std::nullopt;
  RecordHeader header;
  header.payload_bytes = take<std::uint32_t>(bytes);
  header.payload_checksum = take<std::uint32_t>(bytes);
  header.bytes = kFirstRecordHeaderBytes;
  bytes.remove_prefix(kPayloadHeader - 2 * sizeof(std::uint32_t));
  return take_counts(bytes, header.payload_bytes) ? std::optional(header) : std::nullopt;
}

namespace {

std::string encode_record(std::uint32_t kind, const std::string& payload, std::int64_t map_id,
                          std::uint32_t number) {
  std::string record(kSync);
  record.reserve(kRecordHeaderBytes + payload.size());
  put(record, kind);
  put(record, static_cast<std::uint32_t>(payload.size()));
  put(record, number);
  put(record, map_id);
  put(record, checksum_of(payload));
  put(record, checksum_of(record));
  return record += payload;
}

}  // namespace

std::string encode_record(const Keyframe& keyframe, std::int64_t map_id, std::uint32_t number) {
  return encode_record(RecordHeader::kKeyframe, encode_payload(keyframe), map_id, number);
}

std::string encode_moved(std::int64_t moves, std::int64_t map_id, std::uint32_t number) {
  std::string payload;
  put(payload, moves);
  return encode_record(RecordHeader::kMoved, payload, map_id, number);
}

std::optional<Keyframe> decode_payload(std::string_view payload) {
  if (payload.size() < kPayloadHeader) return std::nullopt;
  const std::size_t payload_bytes = payload.size();
  Keyframe keyframe;
  keyframe.cloud.utime_us = take<std::int64_t>(payload);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column)
      keyframe.T_map_base(row, column) = take<double>(payload);
  }
  const auto counts = take_counts(payload, payload_bytes);
  if (!counts || !keyframe.T_map_base.matrix().allFinite()) return std::nullopt;
  keyframe.cloud.points = take_points(payload, counts->points);
  keyframe.cloud.origins = take_points(payload, counts->origins);
  return keyframe;
}

}  // namespace voxlist::mapping
