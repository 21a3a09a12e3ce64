#include "services/voxlist/output/fresh_file.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace fs = std::filesystem;

FreshFile::FreshFile(fs::path target) : target_(std::move(target)), path_(target_) {
  path_ += fmt::format(".unfinished-{}", getpid());
  std::error_code ignored;
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

}  // namespace voxlist::desk
