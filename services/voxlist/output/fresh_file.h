#pragma once

#include <filesystem>

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

  /// Puts it into its place. Throws FileError.
  void publish();

 private:
  const std::filesystem::path target_;
  std::filesystem::path path_;
};

}  // namespace voxlist::desk
