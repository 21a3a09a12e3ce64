#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace voxlist::io {

/// A file that cannot be read or written: "path: what is wrong, what to do", ready for a person to
/// read.
class FileError : public std::runtime_error {
 public:
  FileError(const std::filesystem::path& path, const std::string& problem)
      : std::runtime_error(path.string() + ": " + problem) {}
};

/// All bytes of a regular file. Throws FileError when it is missing, unreadable, not a regular file
/// (a pipe would block) or larger than 2 GiB.
std::string read_file(const std::filesystem::path& path);

}  // namespace voxlist::io
