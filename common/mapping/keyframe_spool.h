#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <vector>

#include "voxlist/mapping/map_builder.h"
#include "voxlist/mapping/map_store.h"
#include "voxlist/system/file_descriptor.h"

namespace voxlist::mapping {

/// One of a spool's keyframes, and where it is now: as long as a map is made, places change.
struct SpooledKeyframe {
  std::size_t index = 0;
  Pose3 T_map_base = Pose3::Identity();
  /// Odometry's pose at its time, if there was odometry.
  std::optional<Pose2> T_odom_base = std::nullopt;
};

/// The keyframes of a map in the making, whose id is not known yet: on the disk, in a file without
/// a name, which goes with this object however the process ends. Several threads may read and add
/// at once.
class KeyframeSpool {
 public:
  /// Throws FileError when nothing can be written in the folder.
  explicit KeyframeSpool(const std::filesystem::path& folder);

  /// Returns its index: they are counted from 0. Throws FileError (full disk).
  std::size_t add(const Keyframe& keyframe);

  /// A keyframe where it is now. Throws FileError when the disk has lost it.
  Keyframe read(const SpooledKeyframe& keyframe);

  /// Writes a keyframe file of these, all or nothing. Throws FileError.
  void write(const std::filesystem::path& file, std::int64_t map_id,
             const std::vector<SpooledKeyframe>& keyframes);

 private:
  std::filesystem::path folder_;
  FileDescriptor file_;
  std::optional<StoredKeyframes> stored_;
  std::uint64_t bytes_ = 0;
  std::mutex mutex_;  // of the file
};

}  // namespace voxlist::mapping
