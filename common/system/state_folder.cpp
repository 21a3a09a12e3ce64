#include "voxlist/system/state_folder.h"

#include <cstdlib>
#include <stdexcept>

namespace voxlist {
namespace {

// Empty when the variable is not set.
std::filesystem::path from_environment(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? "" : value;
}

}  // namespace

std::filesystem::path state_folder() {
  if (const auto folder = from_environment("STATE_DIRECTORY"); !folder.empty()) return folder;
  if (const auto state = from_environment("XDG_STATE_HOME"); !state.empty())
    return state / "voxlist";
  if (const auto home = from_environment("HOME"); !home.empty())
    return home / ".local/state/voxlist";
  throw std::runtime_error("no folder for data: set XDG_STATE_HOME, or HOME");
}

std::filesystem::path in_state_folder(const std::filesystem::path& folder) {
  if (folder.empty() || folder.is_absolute()) return folder;
  return state_folder() / folder;
}

}  // namespace voxlist
