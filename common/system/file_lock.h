#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "voxlist/system/file_descriptor.h"

namespace voxlist {

/// A lock that one process holds: on a bus, on a folder. The file holds the owner's process id; the
/// kernel lets go of the lock when the process ends, however it ends.
class FileLock {
 public:
  /// Takes the lock; nothing if somebody else holds it. Throws std::runtime_error if the file
  /// cannot be written or locked.
  static std::optional<FileLock> take(const std::filesystem::path& file);

 private:
  explicit FileLock(FileDescriptor file) : file_(std::move(file)) {}
  FileDescriptor file_;
};

/// Process id that a lock file holds, "?" if there is none.
std::string lock_owner(const std::filesystem::path& file);

/// Whether a process holds the lock now. False when there is no such file.
bool is_locked(const std::filesystem::path& file);

}  // namespace voxlist
