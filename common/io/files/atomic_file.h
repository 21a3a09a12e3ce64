#pragma once

#include <filesystem>
#include <string_view>

#include "voxlist/system/file_descriptor.h"

namespace voxlist::io {

/// A file in the making, under another name beside its own: whoever opens the target, even after a
/// crash or a power cut, finds either the old content or the new one, complete. A symbolic link is
/// replaced by the file. Each function throws FileError (full disk, no permission, target is not a
/// regular file); then the old file is untouched and the temporary one is gone.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  void write(std::string_view bytes);

  /// Brings all that was written to the disk and puts it in the target's place.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
  FileDescriptor file_;
  bool renamed_ = false;
};

/// Writes a whole file as an AtomicFile.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Removes the temporary files that processes which ended within an atomic write left in a folder.
/// Those of living processes stay.
void remove_stale_temporaries(const std::filesystem::path& folder);

}  // namespace voxlist::io
