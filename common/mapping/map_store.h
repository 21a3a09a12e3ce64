#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "voxlist/mapping/map_builder.h"

namespace voxlist::mapping {

/// Name of the keyframe file in a map folder.
inline constexpr const char* kKeyframeFile = "keyframes.voxlist";

/// What a map folder holds.
struct StoredMap {
  std::int64_t map_id = 0;
  std::vector<Keyframe> keyframes;
  /// What was mended on reading, for the log; empty when the file was whole.
  std::string warning;
};

/// Reads a map folder's keyframes. Damaged records (a torn last one after a crash, a flipped bit)
/// are left out with a warning. Throws FileError when there is no such file or it is no keyframe
/// file.
StoredMap load_map(const std::filesystem::path& folder);

/// The keyframes of a map on disk: append-only, each record with its checksum, so that a crash
/// costs at most the record that was being written.
class MapStore {
 public:
  /// Writes a new keyframe file with these keyframes, atomically, in place of one that is there,
  /// and keeps it open for more. Creates the folder. Throws FileError.
  MapStore(const std::filesystem::path& folder, std::int64_t map_id,
           const std::vector<Keyframe>& keyframes);

  /// Opens the folder's file to append to. It must be whole (load_map gave no warning). Throws
  /// FileError.
  explicit MapStore(const std::filesystem::path& folder);

  ~MapStore();
  MapStore(const MapStore&) = delete;
  MapStore& operator=(const MapStore&) = delete;

  /// Appends a keyframe. Throws FileError (full disk); then the file is as it was before.
  void append(const Keyframe& keyframe);

  /// Makes sure that what was appended survives a power cut. Throws FileError.
  void sync();

 private:
  std::filesystem::path path_;
  int fd_ = -1;
};

}  // namespace voxlist::mapping
