#include "voxlist/io/files/atomic_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <optional>
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

constexpr std::string_view kMark = ".tmp-";

// "FILE.tmp-PID-NUMBER"
fs::path temporary_name(fs::path target) {
  static std::atomic<unsigned> counter{0};
  return target += fmt::format("{}{}-{}", kMark, ::getpid(), counter++);
}

// The process that a temporary file's name tells of; nothing when it is no such name.
std::optional<pid_t> maker_of(const std::string& name) {
  const std::size_t mark = name.rfind(kMark);
  if (mark == std::string::npos) return std::nullopt;
  const char* const end = name.data() + name.size();
  pid_t process = 0;
  unsigned number = 0;
  const auto [dash, bad] = std::from_chars(name.data() + mark + kMark.size(), end, process);
  if (bad != std::errc() || dash == end || *dash != '-' || process <= 0) return std::nullopt;
  const auto [rest, worse] = std::from_chars(dash + 1, end, number);
  return worse == std::errc() && rest == end ? std::optional(process) : std::nullopt;
}

bool is_gone(pid_t process) { return ::kill(process, 0) != 0 && errno == ESRCH; }

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

AtomicFile::AtomicFile(fs::path target)
    : target_(std::move(target)), path_(temporary_name(target_)) {
  std::error_code ignored;
  const auto status = fs::status(target_, ignored);
  // Renaming over a device such as /dev/null would replace the device.
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw FileError(target_, "is there and not a regular file, choose another name");
  }
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW;
  file_ = FileDescriptor(::open(path_.c_str(), kFlags, 0666));
  if (file_.get() < 0) throw failed(target_, "creating a file beside it");
}

AtomicFile::~AtomicFile() {
  if (!renamed_) ::unlink(path_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_.get(), bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) throw failed(target_, "writing");
    bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
}

void AtomicFile::commit() {
  if (::fsync(file_.get()) != 0) throw failed(target_, "writing to the disk");
  // Some file systems report a full disk only here.
  if (::close(file_.release()) != 0) throw failed(target_, "closing");
  if (::rename(path_.c_str(), target_.c_str()) != 0) {
    throw failed(target_, "renaming the finished file");
  }
  renamed_ = true;
  sync_folder_of(target_);
}

void write_file_atomically(const fs::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

void remove_stale_temporaries(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const auto maker = maker_of(entry->path().filename().string());
    if (maker && is_gone(*maker)) ::unlink(entry->path().c_str());
  }
}

}  // namespace voxlist::io
