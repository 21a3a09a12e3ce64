#include "services/voxlist/output/fresh_file.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "services/voxlist/output/stop.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace fs = std::filesystem;

FreshFile::FreshFile(fs::path target) : target_(std::move(target)), path_(target_) {
  // As io::AtomicFile names its own, so that the same call takes away what a killed process left.
  static unsigned number = 0;
  path_ += fmt::format(".tmp-{}-{}", getpid(), number++);
  std::error_code ignored;
  io::remove_stale_temporaries(target_.has_parent_path() ? target_.parent_path() : ".");
  if (fs::exists(target_, ignored) && !fs::is_regular_file(target_, ignored)) {
    throw io::FileError(target_, "is there and no regular file, choose another name");
  }
  if (!std::ofstream(path_)) {
    throw io::FileError(target_, std::string("cannot be written (") + std::strerror(errno) +
                                     "), check the folder and its permissions");
  }
}

FreshFile::~FreshFile() {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

void FreshFile::publish() {
  std::error_code failure;
  fs::rename(path_, target_, failure);
  if (failure) throw io::FileError(target_, "cannot be replaced (" + failure.message() + ")");
}

int publish_or_keep_older(FreshFile& file, Console& console, const std::string& result) {
  const bool interrupted = stop_requested();
  std::error_code ignored;
  if (interrupted && fs::exists(file.target(), ignored)) {
    console.warn("interrupted: " + file.target().string() + " stays as it was");
    return kInterrupted;
  }
  file.publish();
  console.say(result);
  if (interrupted) console.warn("interrupted: " + file.target().string() + " ends there");
  return interrupted ? kInterrupted : 0;
}

}  // namespace voxlist::desk
