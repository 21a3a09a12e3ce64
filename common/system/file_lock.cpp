#include "voxlist/system/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace voxlist {
namespace {

std::runtime_error failed(const std::filesystem::path& file) {
  return std::runtime_error(file.string() + ": " + std::strerror(errno));
}

// False: somebody else holds it.
bool lock(int file, const std::filesystem::path& path) {
  if (flock(file, LOCK_EX | LOCK_NB) == 0) return true;
  if (errno != EWOULDBLOCK) throw failed(path);
  return false;
}

}  // namespace

std::optional<FileLock> FileLock::take(const std::filesystem::path& file) {
  FileDescriptor opened(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (opened.get() < 0) throw failed(file);
  if (!lock(opened.get(), file)) return std::nullopt;
  const std::string owner = std::to_string(getpid()) + "\n";
  if (ftruncate(opened.get(), 0) != 0 || write(opened.get(), owner.data(), owner.size()) < 0)
    throw failed(file);
  return FileLock(std::move(opened));
}

std::string lock_owner(const std::filesystem::path& file) {
  std::string owner;
  std::ifstream(file) >> owner;
  return owner.empty() ? "?" : owner;
}

bool is_locked(const std::filesystem::path& file) {
  const FileDescriptor opened(open(file.c_str(), O_RDONLY | O_CLOEXEC));
  return opened.get() >= 0 && !lock(opened.get(), file);
}

}  // namespace voxlist
