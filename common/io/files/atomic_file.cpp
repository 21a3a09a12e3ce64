#include "voxlist/io/files/atomic_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "voxlist/io/files/file.h"

namespace voxlist::io {
namespace {

namespace fs = std::filesystem;

FileError failed(const fs::path& path, const std::string& action) {
  return {path, fmt::format(
                    "{} failed ({}), check free space and permissions; the file was left as it was",
                    action, std::strerror(errno))};
}

class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : target_(target), path_(target) {
    static std::atomic<unsigned> counter{0};
    path_ += fmt::format(".tmp-{}-{}", ::getpid(), counter++);
    descriptor_ =
        ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor_ < 0) {
      throw failed(target_, "creating a file beside it");
    }
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
    if (!renamed_) {
      ::unlink(path_.c_str());
    }
  }

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno != EINTR) {
        throw failed(target_, "writing");
      }
      bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
    }
  }

  void commit() {
    if (::fsync(descriptor_) != 0) {
      throw failed(target_, "writing to the disk");
    }
    // Some file systems report a full disk only here.
    if (::close(std::exchange(descriptor_, -1)) != 0) {
      throw failed(target_, "closing");
    }
    if (::rename(path_.c_str(), target_.c_str()) != 0) {
      throw failed(target_, "renaming the finished file");
    }
    renamed_ = true;
  }

 private:
  fs::path target_;
  fs::path path_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

// The rename itself is only safe from a power cut once the folder is on the disk. Not every file
// system can sync a folder, and the file is complete either way, so this failing is no error.
void sync_folder_of(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0) {
    ::fsync(descriptor);
    ::close(descriptor);
  }
}

}  // namespace

void write_file_atomically(const fs::path& path, std::string_view bytes) {
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  // Renaming over a device such as /dev/null would replace the device.
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw FileError(path, "is there and not a regular file, choose another name");
  }
  TemporaryFile file(path);
  file.write(bytes);
  file.commit();
  sync_folder_of(path);
}

}  // namespace voxlist::io
