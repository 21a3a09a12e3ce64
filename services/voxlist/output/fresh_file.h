#pragma once

#include <filesystem>
#include <string>

#include "services/voxlist/output/console.h"

namespace voxlist::desk {

/// A large file in the making: it is written under another name beside its place, and takes the
/// place of the old one only when it is whole. Gone if it is not published.
class FreshFile {
 public:
  /// Throws FileError when no file can be made there.
  explicit FreshFile(std::filesystem::path target);
  ~FreshFile();
  FreshFile(const FreshFile&) = delete;
  FreshFile& operator=(const FreshFile&) = delete;

  /// Where to write it.
  const std::filesystem::path& path() const { return path_; }

  /// Its place.
  const std::filesystem::path& target() const { return target_; }

  /// Puts it into its place. Throws FileError.
  void publish();

 private:
  const std::filesystem::path target_;
  std::filesystem::path path_;
};

/// Publishes the file and says `result`. After Ctrl-C the file is only the start of what was asked
/// for: it is published, with a warning, where no older file is; an older one stays. Returns the
/// exit code. Throws FileError.
int publish_or_keep_older(FreshFile& file, Console& console, const std::string& result);

}  // namespace voxlist::desk
