#include "tests/bench/paths/grid_paths.h"

#include <fmt/core.h>

#include <voxlist/pixel_map_t.hpp>

#include "services/grid_export/grid_messages.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/planning/grids/grid_builder.h"
#include "voxlist/planning/grids/grid_files.h"

namespace voxlist::bench {
namespace {

constexpr bus::Channel<pixel_map_t> kGrid{"GRID_robot"};

planning::TypedGrid grid_of(const std::vector<PosedScan>& scans, const Body& body) {
  mapping::MapBuilderConfig config;
  config.count_free = true;
  mapping::MapBuilder map(config);
  std::vector<Eigen::Vector3d> way;
  for (const PosedScan& scan : scans) {
    map.add({to_pose3(scan.pose), scan.cloud});
    way.emplace_back(scan.pose.x_m, scan.pose.y_m, 0.0);
  }
  planning::RobotProfile robot;
  robot.radius_m = body.radius_m;
  robot.height_m = body.high_m;
  planning::GridBuilder builder({robot});
  builder.take(map.map(), map.free_space());
  builder.drive(way);
  builder.update();
  return builder.grids().at(0);
}

FreeCells free_cells(const planning::TypedGrid& grid) {
  const Eigen::Vector2d low = planning::corner_m(grid.box),
                        size(grid.box.width(), grid.box.height());
  return {low, low + (size.array() - 0.5).matrix() * planning::kColumn_m, planning::kColumn_m,
          [&](const Eigen::Vector2d& p) {
            const planning::Cell cell{static_cast<int>(std::floor(p.x() / planning::kColumn_m)),
                                      static_cast<int>(std::floor(p.y() / planning::kColumn_m))};
            return grid.at(cell) == planning::CellType::kFree;
          }};
}

}  // namespace

PathTally plan_in_grid(int seed, int errands, const Body& body) {
  const simulation::Building building = simulation::make_building({.seed = seed, .stairs = 1});
  const planning::TypedGrid grid =
      grid_of(mirror_scans_along_tour(building, static_cast<std::uint64_t>(1000 * seed)), body);
  const FreeCells known = free_cells(grid);
  const test::TemporaryFolder folder;
  const std::string log = (folder / "grid.lcm").string();
  bus::EventLogWriter writer(log);
  services::BandedZlib zlib;
  writer.write(kGrid, 1, services::to_pixel_map(grid, {.utime_us = 1}, zlib));
  writer.close();
  simulation::Random random(4716, static_cast<std::uint64_t>(seed));
  PathTally tally;
  for (int i = 0; i < errands; ++i) {
    const Errand errand = random_errand(building, known, body, random);
    const auto path = points_of(fmt::format(
        "LCM_DEFAULT_URL='file://{}?speed=0' '" VOXLIST_BIN_DIR "/grid_planner' {} {} {} {} {} {}",
        log, kGrid.name, body.radius_m + body.margin_m, errand.start.x(), errand.start.y(),
        errand.goal.x(), errand.goal.y()));
    tally.add(errand, path, building, known, body);
  }
  return tally;
}

}  // namespace voxlist::bench
