#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "voxlist/io/files/atomic_file.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/system/file_descriptor.h"

namespace voxlist::mapping {

/// A keyframe file that takes the place of the one that is there once it is whole. Each function
/// throws FileError; then what was there is as it was.
class NewKeyframeFile {
 public:
  NewKeyframeFile(const std::filesystem::path& file, std::int64_t map_id);

  /// Returns where it lies in the file.
  KeyframePlace add(const Keyframe& keyframe);

  /// Brings all to the disk and puts it in place.
  void commit() { file_.commit(); }

 private:
  io::AtomicFile file_;
  std::int64_t map_id_;
  std::uint32_t number_ = 0;
  std::uint64_t bytes_ = kFileHeaderBytes;
};

/// Writes all bytes to a file descriptor. False, with errno, when it cannot.
bool write_all(int file, std::string_view bytes);

/// Appends keyframes to a file, each to the disk before the next one.
class KeyframeWriter {
 public:
  /// Opens a keyframe file that is there. `next_number` as KeyframeReader tells it. Throws
  /// FileError.
  KeyframeWriter(const std::filesystem::path& file, std::int64_t map_id, std::uint32_t next_number);

  /// Returns when the keyframe would survive a power cut, and where it lies in the file. Throws
  /// FileError (full disk): then the file holds what it held before, and the same keyframe can be
  /// appended again.
  KeyframePlace append(const Keyframe& keyframe);

  /// Says in the file that keyframes were moved: the graph tells where they are. As append().
  void append_moved(std::int64_t moves);

  /// Whether the file is still where it was opened, and nobody has cut it.
  bool is_in_place() const;

 private:
  KeyframePlace append(const std::string& record);

  std::filesystem::path path_;
  FileDescriptor file_;
  std::int64_t map_id_;
  std::uint32_t next_number_;
  std::int64_t size_ = 0;  // bytes after the last keyframe that is safe
};

}  // namespace voxlist::mapping
