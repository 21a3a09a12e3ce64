#include "services/voxlist/commands/views/export_views.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>
#include <vector>

#include "services/voxlist/commands/settings.h"
#include "services/voxlist/commands/views/distance_field.h"
#include "services/voxlist/commands/views/virtual_scans.h"
#include "services/voxlist/maps/octomap_of.h"
#include "services/voxlist/maps/stored_map.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"
#include "voxlist/planning/grids/grid_builder.h"
#include "voxlist/planning/grids/grid_files.h"

namespace voxlist::desk {
namespace {

namespace fs = std::filesystem;

// Sides of the tiles of an image (cells), and of a distance field, whose tiles are boxes of cells.
constexpr std::int32_t kImageTile = 4096, kFieldTile = 512;

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure || !fs::is_directory(folder, failure))
    throw io::FileError(folder, "cannot be made a folder, check the name and its permissions");
}

planning::GridBuilder builder_of(const StoredMap& map, const ViewOptions& options) {
  planning::GridBuilder builder(read_robots(options.config).in_use());
  std::vector<Eigen::Vector3d> way;
  for (const StampedPose3& pose : map.poses) way.push_back(pose.pose.translation());
  builder.drive(std::move(way));
  builder.take(map.builder.map(), map.builder.free_space());
  builder.update();
  return builder;
}

void write_tiles(const planning::TypedGrid& grid, const std::string& name,
                 const ViewOptions& options, Console& console) {
  const std::int32_t side = options.tiles ? kImageTile : planning::kLargestImage;
  const auto tiles = planning::tiles_of(grid.box, side);
  if (tiles.size() > 1 && !options.tiles)
    throw io::FileError(options.folder / (name + ".pgm"),
                        "would be too large for one image, give --tiles");
  for (const planning::GridTile& tile : tiles)
    planning::write_grid(planning::part_of(grid, tile.box), options.folder, name + tile.suffix);
  const auto free = std::ranges::count(grid.cells, planning::CellType::kFree);
  console.say(fmt::format("{}: {} x {} cells, {:.1f} m2 free{}",
                          (options.folder / (name + ".yaml")).string(), grid.box.width(),
                          grid.box.height(),
                          static_cast<double>(free) * planning::kColumn_m * planning::kColumn_m,
                          tiles.size() > 1 ? fmt::format(", in {} tiles", tiles.size()) : ""));
}

void write_grids(const StoredMap& map, const ViewOptions& options, Console& console) {
  const planning::GridBuilder builder = builder_of(map, options);
  if (builder.cells() > planning::kMostCells)
    throw io::FileError(options.map, "spans more than 512 x 512 m, which no grid does");
  const std::vector<planning::TypedGrid>& grids = builder.grids();
  for (std::size_t i = 0; i < grids.size(); ++i)
    write_tiles(grids[i], builder.robots()[i].name, options, console);
}

void write_field(const StoredMap& map, const VoxelBox& box, const std::string& name,
                 const ViewOptions& options, Console& console) {
  const DistanceField field =
      distance_field(map.builder.map(), map.builder.free_space(), box, options.most_m);
  io::write_file_atomically(options.folder / (name + ".npy"), npy(field));
  io::write_file_atomically(options.folder / (name + ".yaml"),
                            place_yaml(field, name + ".npy", options.most_m));
  console.say(fmt::format("{}: {} x {} x {} cells", (options.folder / (name + ".npy")).string(),
                          field.count(0), field.count(1), field.count(2)));
}

void write_distances(const StoredMap& map, const ViewOptions& options, Console& console) try {
  const auto box = known_box(map.builder.free_space());
  if (!box) return;
  if (!options.tiles) return write_field(map, *box, "distance", options, console);
  const planning::CellBox plan{{box->lowest.x, box->lowest.y},
                               {box->highest.x + 1, box->highest.y + 1}};
  for (const planning::GridTile& tile : planning::tiles_of(plan, kFieldTile))
    write_field(map,
                {{tile.box.low.x, tile.box.low.y, box->lowest.z},
                 {tile.box.high.x - 1, tile.box.high.y - 1, box->highest.z}},
                "distance" + tile.suffix, options, console);
} catch (const std::length_error& error) {
  throw io::FileError(options.folder / "distance.npy", error.what());
}

bool write_octomap(const ViewOptions& options, Console& console) {
  const planning::OctomapConfig config = read_settings(options.config).octomap;
  const planning::OctomapCut cut = planning::cut_of(config);
  const auto octomap = octomap_of(options.map, config, 0, console);
  if (!octomap) return false;
  octomap->write_bt(options.folder / "map.bt", cut);
  console.say((options.folder / "map.bt").string());
  return true;
}

}  // namespace

void add_views(CLI::App& command, ViewOptions& views) {
  command.add_flag("--grid", views.grid,
                   "a floor plan for each robot: NAME.pgm and NAME.yaml for map_server, and "
                   "NAME.png with overhangs and holes");
  command.add_flag("--scan", views.scan,
                   "a 2D scan of each keyframe for each robot: NAME_scan.csv, the nearest point of "
                   "each bearing at its heights, and NAME_scan_far.csv, the furthest");
  command.add_flag("--distance", views.distance,
                   "distance.npy: how far each place is from what is not free (NumPy)");
  command.add_option("--most", views.most_m, "up to which distances are told (m)")
      ->check(CLI::Range(0.1, 10.0))
      ->capture_default_str();
  command.add_flag("--octomap", views.octomap, "map.bt, as [octomap_export] says");
  command.add_flag("--tiles", views.tiles,
                   "what is too large for one file in parts, _X_Y behind their names");
}

int export_views(const ViewOptions& options, Console& console) {
  refuse_without_map(options.map);
  make_folder(options.folder);
  if (options.grid || options.distance) {
    mapping::MapBuilderConfig config = read_settings(options.config).mapper;
    config.count_free = true;
    const StoredMap map = read_map(options.map, config, console);
    if (options.grid) write_grids(map, options, console);
    if (options.distance) write_distances(map, options, console);
  }
  if (options.scan)
    write_virtual_scans(options.map, options.folder, read_robots(options.config).in_use(), console);
  if (options.octomap && !write_octomap(options, console)) return kInterrupted;
  return 0;
}

}  // namespace voxlist::desk
