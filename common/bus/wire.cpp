#include "voxlist/bus/wire.h"

#include <algorithm>

namespace voxlist::bus {
namespace {

constexpr std::int64_t kInt8 = 1;
constexpr std::int64_t kInt32 = 4;
constexpr std::int64_t kInt64 = 8;
constexpr std::int64_t kFloat = 4;
constexpr std::int64_t kDouble = 8;
constexpr std::int64_t kPoint = 3 * kFloat;
constexpr std::int64_t kPoseMode = (3 + 9 + 3 + 2) * kDouble;
constexpr std::int64_t kVoxelBlock = 3 * kInt32 + 8 * kInt64;
constexpr std::int64_t kEditedBox = kInt64 + kInt32 + 9 * kDouble;
constexpr std::int64_t kBearing = (3 + 1) * kFloat;
constexpr std::int64_t kMovingObstacle = 5 * kFloat;
constexpr std::int64_t kEmptyText = kInt32 + 1;

}  // namespace

const char* fault_name(Fault fault) {
  switch (fault) {
    case Fault::kNone:
      return "none";
    case Fault::kTruncated:
      return "truncated";
    case Fault::kWrongType:
      return "wrong_type";
    case Fault::kBadLength:
      return "bad_length";
    case Fault::kBadText:
      return "bad_text";
    case Fault::kTrailingBytes:
      return "trailing_bytes";
    case Fault::kTooLarge:
      return "too_large";
    case Fault::kCodecFailed:
      return "codec_failed";
  }
  return "unknown";
}

WireReader::WireReader(Bytes bytes) : rest_(bytes) {
  if (static_cast<std::int64_t>(bytes.size()) > kMaxMessageBytes) fail(Fault::kTooLarge);
}

void WireReader::fail(Fault fault) {
  if (fault_ == Fault::kNone) fault_ = fault;
  rest_ = {};
}

void WireReader::skip(std::int64_t bytes) {
  if (bytes > static_cast<std::int64_t>(rest_.size())) return fail(Fault::kTruncated);
  rest_ = rest_.subspan(static_cast<std::size_t>(bytes));
}

std::uint32_t WireReader::read_u32() {
  const Bytes before = rest_;
  skip(kInt32);
  if (fault_ != Fault::kNone) return 0;
  return std::uint32_t{before[0]} << 24 | std::uint32_t{before[1]} << 16 |
         std::uint32_t{before[2]} << 8 | std::uint32_t{before[3]};
}

void WireReader::fingerprint(std::int64_t expected) {
  const std::uint64_t high = read_u32();
  const std::uint64_t low = read_u32();
  if ((high << 32 | low) != static_cast<std::uint64_t>(expected)) fail(Fault::kWrongType);
}

std::int64_t WireReader::count(std::int64_t min_bytes_each, std::int64_t limit) {
  const std::int64_t n = static_cast<std::int32_t>(read_u32());
  if (n < 0) fail(Fault::kBadLength);
  if (n > limit) fail(Fault::kTooLarge);
  if (n * min_bytes_each > static_cast<std::int64_t>(rest_.size())) fail(Fault::kTruncated);
  return fault_ == Fault::kNone ? n : 0;
}

std::int64_t WireReader::array(std::int64_t bytes_each) {
  const std::int64_t n = count(bytes_each);
  skip(n * bytes_each);
  return n;
}

void WireReader::text() {
  const std::int64_t n = count(1);
  if (fault_ != Fault::kNone) return;
  if (n == 0) return fail(Fault::kBadLength);
  const Bytes characters = rest_.first(static_cast<std::size_t>(n));
  if (std::ranges::find(characters, 0) != characters.end() - 1) return fail(Fault::kBadText);
  skip(n);
}

void WireReader::named_values(std::int64_t bytes_each) {
  const std::int64_t n = count(kEmptyText + bytes_each);
  for (std::int64_t i = 0; i < n; ++i) {
    text();
    skip(bytes_each);
  }
}

Fault WireReader::finish() const {
  if (fault_ != Fault::kNone) return fault_;
  return rest_.empty() ? Fault::kNone : Fault::kTrailingBytes;
}

void walk(WireReader& in, const health_t*) {
  in.skip(kInt64);
  in.text();
  in.text();
  in.skip(2 * kInt32);
  in.text();
  in.named_values(kInt64);
  in.named_values(kDouble);
  in.skip(3 * kFloat);
}

void walk(WireReader& in, const keyframe_t*) {
  in.skip(2 * kInt64 + kInt32 + 7 * kDouble);
  in.array(kPoint);
  in.array(kPoint);
}

void walk(WireReader& in, const localisation_t*) {
  in.skip(3 * kInt64 + kInt32);
  in.array(kPoseMode);
  in.skip(2 * kDouble + 2 * kInt8 + kInt64 + kInt32 + 3 * kDouble);
}

void walk(WireReader& in, const map_edit_t*) { in.skip(3 * kInt64 + kInt32 + 6 * kDouble); }

void walk(WireReader& in, const map_edits_t*) {
  in.skip(3 * kInt64);
  in.text();
  in.skip(2 * kInt64);
  in.array(kEditedBox);
}

void walk(WireReader& in, const map_octree_t*) {
  in.skip(3 * kInt64);
  in.array(1);
  in.skip(16 * kFloat);
}

void walk(WireReader& in, const map_request_t*) { in.skip(3 * kInt64 + 2 * kInt32); }

void walk(WireReader& in, const map_update_t*) {
  in.skip(5 * kInt64 + 2 * kInt32 + 2 * kDouble);
  in.array(kVoxelBlock);
  in.array(kVoxelBlock);
  in.skip(2 * kInt64 + 3 * kDouble);
}

void walk(WireReader& in, const mirror_state_t*) {
  in.skip(kInt64 + 2 * kInt8);
  in.text();
  in.skip(2 * kDouble + kInt64 + 2 * kDouble);
}

void walk(WireReader& in, const obstacles_t*) {
  in.skip(kInt64);
  in.text();
  in.skip(2 * kFloat);
  const std::int64_t n_bearings = in.count(kBearing);
  in.skip(2 * kFloat + n_bearings * kBearing);
  const std::int64_t n_cells = in.count(2 * kFloat + kInt32);
  in.skip(n_cells * (2 * kFloat + kInt32));
  in.array(kMovingObstacle);
}

void walk(WireReader& in, const pixel_map_t*) {
  in.skip(kInt64 + 2 * kInt32 + 5 * kDouble + 2 * kInt8);
  in.array(kInt8);
}

void walk(WireReader& in, const planar_lidar_t*) {
  in.skip(kInt64);
  in.array(kFloat);
  in.array(kFloat);
  in.skip(2 * kFloat);
}

void walk(WireReader& in, const pointcloud_t*) {
  in.skip(kInt64 + kInt32);
  in.text();
  const std::int64_t n_points = in.array(kPoint);
  const std::int64_t n_channels = in.count(kEmptyText, kMaxCloudChannels);
  for (std::int64_t i = 0; i < n_channels; ++i) in.text();
  in.skip(n_channels * n_points * kFloat);
}

void walk(WireReader& in, const pose_hint_t*) { in.skip(2 * kInt64 + 5 * kDouble); }

void walk(WireReader& in, const pose_t*) { in.skip(kInt64 + 16 * kDouble); }

void walk(WireReader& in, const rigid_transform_t*) { in.skip(kInt64 + 7 * kDouble); }

void walk(WireReader& in, const traversability_t*) {
  in.skip(3 * kInt64);
  in.text();
  in.skip(3 * kDouble + 2 * kInt32 + kInt8);
  in.array(kInt8);
}

void walk(WireReader& in, const uncertain_pose_t*) { in.skip(4 * kInt64 + 12 * kDouble); }

}  // namespace voxlist::bus
