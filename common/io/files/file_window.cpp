#include "voxlist/io/files/file_window.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

// Bytes that are read at once: enough that a large file is read as fast as the disk can.
constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;

}  // namespace

// Without O_NONBLOCK a pipe would wait for its other end.
FileWindow::FileWindow(const std::filesystem::path& path)
    : path_(path), file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (file_.get() < 0 && errno == ENOENT) throw FileError(path, "no such file, check the path");
  struct stat info {};
  if (file_.get() < 0 || ::fstat(file_.get(), &info) != 0) {
    throw FileError(path, std::string("cannot be read: ") + std::strerror(errno));
  }
  if (!S_ISREG(info.st_mode)) throw FileError(path, "not a regular file, give the path of one");
  size_ = static_cast<std::uint64_t>(info.st_size);
}

void FileWindow::refresh() {
  struct stat info {};
  if (::fstat(file_.get(), &info) != 0)
    throw FileError(path_, std::string("cannot be read: ") + std::strerror(errno));
  size_ = static_cast<std::uint64_t>(info.st_size);
  bytes_.clear();
}

std::string_view FileWindow::at(std::uint64_t offset, std::uint64_t count) {
  offset = std::min(offset, size_);
  count = std::min(count, size_ - offset);
  if (offset < start_ || offset + count > start_ + bytes_.size()) load(offset, count);
  return std::string_view(bytes_).substr(std::min<std::size_t>(offset - start_, bytes_.size()),
                                         count);
}

void FileWindow::load(std::uint64_t offset, std::uint64_t count) {
  bytes_.clear();
  bytes_.resize(std::min(std::max(count, kPiece), size_ - offset));
  start_ = offset;
  for (std::size_t done = 0; done < bytes_.size();) {
    const ssize_t read = ::pread(file_.get(), bytes_.data() + done, bytes_.size() - done,
                                 static_cast<off_t>(offset + done));
    if (read < 0 && errno == EINTR) continue;
    if (read < 0) throw FileError(path_, std::string("cannot be read: ") + std::strerror(errno));
    done += static_cast<std::size_t>(read);
    if (read == 0) bytes_.resize(done);  // it was cut meanwhile
  }
}

}  // namespace voxlist::io
