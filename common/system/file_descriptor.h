#pragma once

#include <utility>

namespace voxlist {

/// An open file of the system, closed with the object. -1: none.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~FileDescriptor();

  int get() const { return fd_; }

  /// Gives the file away: it is not closed here any more.
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

}  // namespace voxlist
