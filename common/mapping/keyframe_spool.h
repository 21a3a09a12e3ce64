#pragma once

#include <cstdint>
#include <filesystem>

#include "voxlist/mapping/map_builder.h"
#include "voxlist/system/file_descriptor.h"

namespace voxlist::mapping {

/// The keyframes of a map in the making, whose id is not known yet: on the disk, in a file without
/// a name, which goes with this object however the process ends.
class KeyframeSpool {
 public:
  /// Throws FileError when nothing can be written in the folder.
  explicit KeyframeSpool(const std::filesystem::path& folder);

  /// Throws FileError (full disk).
  void add(const Keyframe& keyframe);

  /// Writes a keyframe file of all of them, all or nothing. Throws FileError.
  void write(const std::filesystem::path& file, std::int64_t map_id) const;

 private:
  std::filesystem::path folder_;
  FileDescriptor file_;
  std::uint32_t number_ = 0;
};

}  // namespace voxlist::mapping
