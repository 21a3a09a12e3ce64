#include "services/voxlist/settings.h"

#include <stdexcept>

#include "config/config.h"
#include "config/tables.h"

namespace voxlist {
namespace {

// Into the sections' structs; throws with all complaints.
void read(const std::filesystem::path& file, const std::vector<Section>& sections) {
  if (file.empty()) return;
  std::string all;
  for (const std::string& complaint : read_config(file, sections, kTables))
    all += (all.empty() ? "" : "\n") + complaint;
  if (!all.empty()) throw std::runtime_error(all);
}

}  // namespace

DeskSettings read_settings(const std::filesystem::path& file) {
  DeskSettings settings;
  read(file,
       {shared_section("localiser", settings.localiser), shared_section("mapper", settings.mapper),
        shared_section("octomap_export", settings.octomap)});
  return settings;
}

CloudAssemblerConfig read_scanner_settings(const std::filesystem::path& file) {
  CloudAssemblerConfig settings;
  read(file, {section("cloud_assembler", settings)});
  return settings;
}

}  // namespace voxlist
