#include "voxlist/io/files/file.h"

#include <fstream>

namespace voxlist::io {
namespace {

// Largest file that is read: 2 GiB, 80 million points. It is read as a whole, into memory.
constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 31;

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) {
    throw FileError(path, "no such file, check the path");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw FileError(path, "not a regular file, give the path of one");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  if (failure || size > kMaxFileBytes) {
    throw FileError(path, "larger than 2 GiB or its size is unknown, split the file");
  }
  std::ifstream in(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!in || !in.read(bytes.data(), static_cast<std::streamsize>(size))) {
    throw FileError(path, "cannot be read, check its permissions and the disk");
  }
  return bytes;
}

}  // namespace voxlist::io
