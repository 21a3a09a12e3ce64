#include "voxlist/mapping/map_store.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string_view>

#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"

// The file: an 8-byte magic, the map id (int64), then records. A record: payload bytes (uint32),
// the payload's CRC-32 as zlib computes it (uint32), payload. The payload: utime (int64), pose (12
// doubles, row-major 3 x 4), points and origins (uint32 each), then their coordinates (float32).
// All little-endian.

static_assert(std::endian::native == std::endian::little,
              "the keyframe file is written as memory lies");

namespace voxlist::mapping {
namespace {

constexpr std::string_view kMagic = "VOXKF001";
constexpr std::size_t kFileHeader = kMagic.size() + sizeof(std::int64_t);
constexpr std::size_t kRecordHeader = 2 * sizeof(std::uint32_t);
constexpr std::size_t kPayloadHeader =
    sizeof(std::int64_t) + 12 * sizeof(double) + 2 * sizeof(std::uint32_t);
constexpr std::size_t kPoint = 3 * sizeof(float);

std::uint32_t checksum_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

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

std::string encode(const Keyframe& keyframe) {
  std::string payload;
  put(payload, keyframe.cloud.utime_us);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) put(payload, keyframe.T_map_base(row, column));
  }
  put(payload, static_cast<std::uint32_t>(keyframe.cloud.points.size()));
  put(payload, static_cast<std::uint32_t>(keyframe.cloud.origins.size()));
  put(payload, keyframe.cloud.points);
  put(payload, keyframe.cloud.origins);
  std::string record;
  put(record, static_cast<std::uint32_t>(payload.size()));
  put(record, checksum_of(payload));
  return record + payload;
}

// The keyframe in a payload; nothing when its lengths do not fit together, or its pose is no pose.
std::optional<Keyframe> decode(std::string_view payload) {
  if (payload.size() < kPayloadHeader) return std::nullopt;
  Keyframe keyframe;
  keyframe.cloud.utime_us = take<std::int64_t>(payload);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column)
      keyframe.T_map_base(row, column) = take<double>(payload);
  }
  const std::size_t points = take<std::uint32_t>(payload), origins = take<std::uint32_t>(payload);
  if (payload.size() != (points + origins) * kPoint || (origins != 0 && origins != points))
    return std::nullopt;
  if (!keyframe.T_map_base.matrix().allFinite()) return std::nullopt;
  keyframe.cloud.points = take_points(payload, points);
  keyframe.cloud.origins = take_points(payload, origins);
  return keyframe;
}

// Takes the next record off; its keyframe, or nothing when its payload is damaged or torn.
std::optional<Keyframe> take_record(std::string_view& bytes) {
  const std::size_t size = bytes.size() < kRecordHeader ? bytes.size() : take<std::uint32_t>(bytes);
  const auto checksum = bytes.size() < sizeof(std::uint32_t) ? 0 : take<std::uint32_t>(bytes);
  const std::string_view payload = bytes.substr(0, size);
  bytes.remove_prefix(payload.size());
  if (payload.size() < size || checksum_of(payload) != checksum) return std::nullopt;
  return decode(payload);
}

std::string system_error(const char* doing) {
  return fmt::format("{}: {}", doing, std::strerror(errno));
}

void write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw std::runtime_error(system_error("cannot write"));
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

std::string header(std::int64_t map_id) {
  std::string bytes(kMagic);
  put(bytes, map_id);
  return bytes;
}

int open_to_append(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (fd < 0) throw io::FileError(path, system_error("cannot open"));
  return fd;
}

}  // namespace

StoredMap load_map(const std::filesystem::path& folder) {
  const auto path = folder / kKeyframeFile;
  const std::string file = io::read_file(path);
  if (file.size() < kFileHeader || !file.starts_with(kMagic)) {
    throw io::FileError(path,
                        "is no keyframe file of Voxlist; give the folder that a map was saved to");
  }
  std::string_view rest = std::string_view(file).substr(kMagic.size());
  StoredMap stored;
  stored.map_id = take<std::int64_t>(rest);
  int damaged = 0;
  while (!rest.empty()) {
    if (auto keyframe = take_record(rest)) {
      stored.keyframes.push_back(std::move(*keyframe));
    } else {
      ++damaged;
    }
  }
  if (damaged > 0) {
    stored.warning = fmt::format("{}: left out {} damaged records; {} keyframes are whole",
                                 path.string(), damaged, stored.keyframes.size());
  }
  return stored;
}

MapStore::MapStore(const std::filesystem::path& folder, std::int64_t map_id,
                   const std::vector<Keyframe>& keyframes)
    : path_(folder / kKeyframeFile) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw io::FileError(folder, "cannot create the map folder: " + error.message());
  std::string bytes = header(map_id);
  for (const Keyframe& keyframe : keyframes) bytes += encode(keyframe);
  io::write_file_atomically(path_, bytes);
  fd_ = open_to_append(path_);
}

MapStore::MapStore(const std::filesystem::path& folder)
    : path_(folder / kKeyframeFile), fd_(open_to_append(path_)) {}

MapStore::~MapStore() { ::close(fd_); }

void MapStore::append(const Keyframe& keyframe) {
  struct stat before {};
  const bool known = ::fstat(fd_, &before) == 0;
  try {
    write_all(fd_, encode(keyframe));
  } catch (const std::exception& failure) {
    const bool restored = known && ::ftruncate(fd_, before.st_size) == 0;
    throw io::FileError(path_,
                        failure.what() + std::string(restored ? "; the keyframes before it are safe"
                                                              : "; its last record is torn"));
  }
}

void MapStore::sync() {
  if (::fsync(fd_) != 0) throw io::FileError(path_, system_error("cannot sync"));
}

}  // namespace voxlist::mapping
