#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "services/grid_export/driven_way.h"
#include "services/grid_export/grid_output.h"
#include "services/grid_export/scan_output.h"
#include "voxlist/planning/grids/grid_builder.h"
#include "voxlist/planning/profiles/robot_profile.h"
#include "voxlist/service/inputs/map_follower.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::bus {
class Bus;
class Health;
}  // namespace voxlist::bus

namespace voxlist::services {

/// Settings of the grid export.
struct GridExportConfig {
  std::string folder;
  double save_period_s = 1.0;
  double repeat_period_s = 5.0;
  planning::RobotProfiles robots;

  template <class Visitor>
  void visit(Visitor& v) {
    v("folder", folder,
      "for NAME.pgm, NAME.yaml and NAME.png of each robot, in the state folder if relative; made "
      "if "
      "it is not there; empty: no files");
    v("save_period_s", save_period_s, "files are written at most this often", 1.0, 86'400.0);
    v("repeat_period_s", repeat_period_s,
      "where the map does not change, the last grids are sent again after this long, for who "
      "starts "
      "later; 0: never",
      0.0, 86'400.0);
  }

  template <class Visitor>
  void visit_root(Visitor& v) {
    robots.visit(v);
  }
};

/// Follows the mapper's map and publishes GRID_NAME and TRAVERSABILITY_NAME for each robot, again
/// and again, and keeps them as files. Of each CLOUD it makes SCAN_NAME and SCAN_FAR_NAME.
class GridExportService {
 public:
  GridExportService(bus::Bus& bus, bus::Health& health, const GridExportConfig& config);

  /// Throws std::invalid_argument for robots that cannot be told apart.
  static void check(const GridExportConfig& config);

  /// Asks for what is missing, makes the grids where the map has changed, sends and saves them.
  void tick(std::int64_t now_us);

  /// Saves what has changed since it was last saved. Throws std::runtime_error when that fails.
  void stop();

 private:
  // A map as it comes in: what it is, and what has changed in it since it was last looked at.
  struct Input {
    service::MapFollower follower;
    OccupancyMap map;
    ChangedBlocks changed;
    bool is_replaced = false;
  };

  void take(const map_update_t& message, Input& input);
  void follow_mapper();
  void ask(Input& input, std::int64_t now_us);
  bool is_whole() const;
  bool is_due(std::int64_t now_us) const;
  bool is_made() const;
  void make(std::int64_t now_us);
  void bring_up_to_date();
  void save(std::int64_t now_us);
  void report();

  bus::Bus& bus_;
  bus::Health& health_;
  const GridExportConfig config_;
  const std::filesystem::path folder_;
  Input occupied_, free_;
  DrivenWay way_;
  planning::GridBuilder builder_;
  ScanOutput scans_;
  GridOutput grids_;
  GridSource source_;
  std::optional<std::int64_t> map_id_;
  std::int64_t moves_ = 0, edits_ = 0;
  bool way_has_grown_ = false;
  std::optional<std::int64_t> made_us_, followed_us_, saved_us_;  // followed: a new map
  std::int64_t took_us_ = 0;
  bool is_saved_ = true;
  std::string save_error_;
};

}  // namespace voxlist::services
