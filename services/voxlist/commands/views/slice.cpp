#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <vector>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/commands/settings.h"
#include "services/voxlist/maps/stored_map.h"
#include "voxlist/drawing/slice_picture.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

struct SliceOptions {
  std::filesystem::path folder, output, config;
  double height_m = 0.0, thickness_m = 0.1;
  bool carve = false, both = false;
};

// Whether a voxel reaches into the heights of the slice.
bool meets(const Voxel& voxel, double resolution_m, const SliceOptions& options) {
  const double low_m = voxel.z * resolution_m;
  return low_m < options.height_m + options.thickness_m && low_m + resolution_m > options.height_m;
}

drawing::MapView view_of(const StoredMap& map, const SliceOptions& options) {
  drawing::MapView view;
  const VoxelMap& occupied = map.builder.map().occupied;
  const VoxelMap& free = map.builder.free_space().passed;
  view.resolution_m = occupied.resolution_m();
  view.free_m = free.resolution_m();
  occupied.for_each_voxel([&](const Voxel& v) {
    if (meets(v, view.resolution_m, options))
      view.occupied.push_back(center(v, view.resolution_m).cast<float>());
  });
  free.for_each_voxel([&](const Voxel& v) {
    if (meets(v, view.free_m, options))
      view.free.push_back(center(v, view.free_m).head<2>().cast<float>());
  });
  return view;
}

// Cells that somebody keeps blocked by hand: planners hold them to be occupied.
std::vector<Eigen::Vector2f> blocked_in(const StoredMap& map, const SliceOptions& options) {
  const VoxelMap& occupied = map.builder.free_space().occupied;
  const std::vector<PlacedBox> boxes = map.builder.edits().placed(map.poses);
  std::vector<Eigen::Vector2f> blocked;
  occupied.for_each_voxel([&](const Voxel& v) {
    const Eigen::Vector3d at = center(v, occupied.resolution_m());
    const auto keeps = [&](const PlacedBox& box) {
      return box.kind == EditKind::kKeepBlocked && box.contains(at);
    };
    if (meets(v, occupied.resolution_m(), options) && std::ranges::any_of(boxes, keeps))
      blocked.push_back(at.head<2>().cast<float>());
  });
  return blocked;
}

drawing::MapSlice slice_of(const SliceOptions& options, bool carve, Console& console) {
  mapping::MapBuilderConfig config = read_settings(options.config).mapper;
  config.carve = carve;
  config.count_free = true;
  const StoredMap map = read_map(options.folder, config, console);
  return {view_of(map, options), blocked_in(map, options),
          fmt::format("height {:g} m, {}", options.height_m,
                      carve ? "without what has gone (carve = true)" : "all that was ever hit")};
}

int draw(const SliceOptions& options, Console& console) {
  if (options.output.extension() != ".png")
    throw io::FileError(options.output, "is no .png, give a name that ends so");
  std::vector<drawing::MapSlice> slices;
  const bool carve = options.carve || read_settings(options.config).mapper.carve;
  if (options.both || !carve) slices.push_back(slice_of(options, false, console));
  if (options.both || carve) slices.push_back(slice_of(options, true, console));
  drawing::draw_slices(slices).write_png(options.output);
  console.say(options.output.string());
  return 0;
}

void add_options(CLI::App& command, SliceOptions& options) {
  command.add_option("MAPDIR", options.folder, "map folder, as voxlist map or the mapper made it")
      ->required();
  command.add_option("HEIGHT", options.height_m, "of the slice's bottom in the map (m)")
      ->required()
      ->check(CLI::Range(-1e4, 1e4));
  command.add_option("-o,--output", options.output, "picture to write, .png")->required();
  command.add_option("--thickness", options.thickness_m, "of the slice (m)")
      ->check(CLI::Range(0.001, 100.0))
      ->capture_default_str();
  command.add_option("--config", options.config, "robot.toml with a table [mapper]");
  command.add_flag("--carve", options.carve, "without what has gone: people, moved furniture");
  command.add_flag("--both", options.both, "with what has gone, and beside that without");
}

}  // namespace

void add_slice(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "slice", "Draws what is free, occupied and unknown at a height of a map.");
  const auto options = std::make_shared<SliceOptions>();
  add_options(*command, *options);
  command->footer(
      "Example:\n"
      "  voxlist slice office_map 1.0 -o office.png --both");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return draw(*options, console); };
  });
}

}  // namespace voxlist::desk
