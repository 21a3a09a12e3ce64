// Each service's README lists the settings that the service has. With VOXLIST_UPDATE_README=1 in
// the environment this test writes the lists first.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include "services/cloud_adapter/cloud_adapter_service.h"
#include "services/cloud_assembler/cloud_assembler_service.h"
#include "services/grid_export/grid_export_service.h"
#include "services/laser_driver/laser_driver_service.h"
#include "services/localiser/localiser_service.h"
#include "services/mapper/mapper_service.h"
#include "services/mirror_monitor/mirror_monitor_service.h"
#include "services/obstacle_detector/obstacle_detector_service.h"
#include "services/octomap_export/octomap_export_service.h"
#include "services/relay/relay_service.h"
#include "services/scan_source/scan_source_service.h"
#include "services/simulator/simulator_service.h"
#include "services/viewer/viewer_service.h"
#include "voxlist/config/config.h"
#include "voxlist/config/tables.h"

namespace voxlist::services {
namespace {

namespace fs = std::filesystem;

const fs::path kServices = fs::path(VOXLIST_SOURCE_DIR) / "services";
const std::string kBegin = "<!-- settings -->\n", kEnd = "<!-- /settings -->";

std::string read(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

template <class Config>
std::string table_of() {
  Config config;
  return config::markdown_table(config::section("", config));
}

// The robots are no service's alone: grid_export's README tells of them.
std::string grid_tables() {
  planning::RobotProfiles robots;
  return table_of<GridExportConfig>() + "\n" + config::markdown_table(config::root_section(robots));
}

const std::map<std::string, std::string> kServiceTables = {
    {"simulator", table_of<SimulatorConfig>()},
    {"laser_driver", table_of<scanner::Lms200Config>()},
    {"mirror_monitor", table_of<MirrorMonitorConfig>()},
    {"cloud_assembler", table_of<scanner::CloudAssemblerConfig>()},
    {"cloud_adapter", table_of<adapter::AdapterConfig>()},
    {"scan_source", table_of<ScanSourceConfig>()},
    {"localiser", table_of<LocaliserServiceConfig>()},
    {"mapper", table_of<MapperServiceConfig>()},
    {"octomap_export", table_of<OctomapExportConfig>()},
    {"grid_export", grid_tables()},
    {"obstacle_detector", table_of<planning::ObstacleConfig>()},
    {"viewer", table_of<ViewerServiceConfig>()},
    {"relay", table_of<fleet::RelayConfig>()},
};

std::set<std::string> service_folders() {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(kServices))
    if (fs::exists(entry.path() / (entry.path().filename().string() + "_service.h")))
      names.insert(entry.path().filename());
  return names;
}

TEST(ServiceReadme, ListsTheSettingsWithTheirDefaults) {
  for (const auto& [service, table] : kServiceTables) {
    const fs::path path = kServices / service / "README.md";
    const std::string text = read(path);
    const std::size_t begin = text.find(kBegin), end = text.find(kEnd);
    if (begin == std::string::npos || end == std::string::npos) {
      ADD_FAILURE() << path << " has no place for its settings: " << kBegin << kEnd;
      continue;
    }
    const std::string expected = text.substr(0, begin + kBegin.size()) + table + text.substr(end);
    if (std::getenv("VOXLIST_UPDATE_README") != nullptr) std::ofstream(path) << expected;
    EXPECT_EQ(read(path), expected) << "VOXLIST_UPDATE_README=1 mends it (services/README.md)";
  }
}

TEST(ServiceReadme, IsThereAndCheckedForEveryService) {
  EXPECT_EQ(service_folders().size(), kServiceTables.size());
  for (const std::string& service : service_folders())
    EXPECT_TRUE(kServiceTables.contains(service)) << service << ": add it to kServiceTables";
}

TEST(ServiceReadme, OfAllServicesHasARowForEach) {
  const std::string map = read(kServices / "README.md");
  ASSERT_FALSE(service_folders().empty());
  for (const std::string& service : service_folders())
    EXPECT_NE(map.find("| [" + service + "](" + service + "/README.md) |"), std::string::npos)
        << "services/README.md has no row for " << service;
}

TEST(ServiceReadme, OfAllServicesKeepsTheOrderOfTheSettingsTables) {
  const std::string map = read(kServices / "README.md");
  std::size_t last = 0;
  for (const std::string& table : config::kTables) {
    if (table == "bus" || table == "robot") continue;  // of no service alone
    const std::size_t row = map.find("| [" + table + "]");
    ASSERT_NE(row, std::string::npos) << table;
    EXPECT_GT(row, last) << table;
    last = row;
  }
}

}  // namespace
}  // namespace voxlist::services
