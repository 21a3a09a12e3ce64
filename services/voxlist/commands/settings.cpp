#include "services/voxlist/commands/settings.h"

#include <stdexcept>

#include "voxlist/config/config.h"
#include "voxlist/config/tables.h"

namespace voxlist::desk {
namespace {

// Into the sections' structs; throws with all complaints.
void read(const std::filesystem::path& file, const std::vector<config::Section>& sections) {
  if (file.empty()) return;
  std::string all;
  for (const std::string& complaint : config::read_config(file, sections, config::kTables))
    all += (all.empty() ? "" : "\n") + complaint;
  if (!all.empty()) throw std::runtime_error(all);
}

}  // namespace

DeskSettings read_settings(const std::filesystem::path& file) {
  DeskSettings settings;
  read(file, {config::shared_section("localiser", settings.localiser),
              config::shared_section("mapper", settings.mapper),
              config::shared_section("octomap_export", settings.octomap)});
  return settings;
}

scanner::CloudAssemblerConfig read_scanner_settings(const std::filesystem::path& file) {
  scanner::CloudAssemblerConfig settings;
  read(file, {config::section("cloud_assembler", settings)});
  return settings;
}

}  // namespace voxlist::desk
