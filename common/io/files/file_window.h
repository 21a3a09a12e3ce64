#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "voxlist/system/file_descriptor.h"

namespace voxlist::io {

/// A file of any size, read a piece at a time: what is in memory is the largest piece asked for, 1
/// MiB at least. What is appended after the opening is seen after refresh(). A file that is removed
/// can still be read.
class FileWindow {
 public:
  /// Opens the file. Throws FileError when it is missing, unreadable or not a regular file.
  explicit FileWindow(const std::filesystem::path& path);

  std::uint64_t size() const { return size_; }
  const std::filesystem::path& path() const { return path_; }

  /// Looks at the file's size again, and forgets what was read of it. Throws FileError.
  void refresh();

  /// `count` bytes from `offset` on, fewer where the file ends. Valid until the next call. Throws
  /// FileError when the disk cannot read them.
  std::string_view at(std::uint64_t offset, std::uint64_t count);

 private:
  void load(std::uint64_t offset, std::uint64_t count);

  std::filesystem::path path_;
  FileDescriptor file_;
  std::uint64_t size_ = 0;
  std::uint64_t start_ = 0;  // where in the file the bytes lie
  std::string bytes_;
};

}  // namespace voxlist::io
