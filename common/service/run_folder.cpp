#include "voxlist/service/run_folder.h"

#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace voxlist::service {
namespace {

std::filesystem::path wanted_folder() {
  if (const char* folder = std::getenv("VOXLIST_RUN_DIR"); folder && *folder) return folder;
  if (const char* folder = std::getenv("XDG_RUNTIME_DIR"); folder && *folder) {
    return std::filesystem::path(folder) / "voxlist";
  }
  return fmt::format("/tmp/voxlist-{}", geteuid());
}

}  // namespace

std::filesystem::path run_folder() {
  const std::filesystem::path folder = wanted_folder();
  mkdir(folder.c_str(), 0700);
  struct stat info;
  // /tmp is everyone's: a folder that someone else put there is not to be trusted.
  if (lstat(folder.c_str(), &info) != 0 || !S_ISDIR(info.st_mode) || info.st_uid != geteuid()) {
    throw std::runtime_error(
        folder.string() +
        " cannot be made or is not this user's; set VOXLIST_RUN_DIR to a folder "
        "of your own");
  }
  return folder;
}

}  // namespace voxlist::service
