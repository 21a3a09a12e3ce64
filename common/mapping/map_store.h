#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mapping/map_builder.h"

namespace voxlist {

/// Name of the keyframe file in a map folder.
inline constexpr const char* kKeyframeFile = "keyframes.voxlist";

/// What a map folder holds.
struct StoredMap {
  std::int64_t map_id = 0;
  std::vector<Keyframe> keyframes;
  /// What was mended on reading, for the log; empty when the file was whole.
  std::string warning;
};

/// Reads a map folder's keyframes. A torn last record (crash, full disk) is left out with a warning.
/// Throws FileError when there is no such file, it is no keyframe file, or damage lies before the end.
StoredMap load_map(const std::filesystem::path& folder);

/// The keyframes of a map on disk: append-only, each record with its checksum, so that a crash costs at most the record
/// that was being written.
class MapStore {
 public:
  /// Opens the folder's keyframe file for appending after `keyframes` records, or creates folder and file. What lies
  /// behind these records (a torn tail) is cut off. Throws FileError.
  MapStore(const std::filesystem::path& folder, std::int64_t map_id, std::size_t keyframes);
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

}  // namespace voxlist
