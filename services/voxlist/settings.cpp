#include "services/voxlist/settings.h"

#include <stdexcept>

#include "config/config.h"
#include "config/tables.h"

namespace voxlist {

DeskSettings read_settings(const std::filesystem::path& file) {
  DeskSettings settings;
  if (file.empty()) return settings;
  const auto complaints = read_config(
      file,
      {shared_section("localiser", settings.localiser), shared_section("mapper", settings.mapper),
       shared_section("octomap_export", settings.octomap)},
      kTables);
  std::string all;
  for (const std::string& complaint : complaints) all += (all.empty() ? "" : "\n") + complaint;
  if (!all.empty()) throw std::runtime_error(all);
  return settings;
}

}  // namespace voxlist
