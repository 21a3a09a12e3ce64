#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/commands/settings.h"
#include "services/voxlist/maps/map_files.h"
#include "services/voxlist/maps/stored_map.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::desk {
namespace {

struct RebuildOptions {
  std::filesystem::path folder;
  MakingOptions making;
};

// Of a map that nobody knows how it was made: each keyframe is a scan that was placed.
Summary summary_of(const StoredMap& map) {
  RunFigures figures;
  figures.scans = figures.placed = std::ssize(map.poses);
  figures.seconds =
      static_cast<double>(map.poses.back().utime_us - map.poses.front().utime_us) * 1e-6;
  return summary_of(figures);
}

void tell(const RebuildOptions& options, const StoredMap& map, std::size_t poses,
          Console& console) {
  const VoxelMap& voxels = map.builder.map().occupied;
  console.say(fmt::format("{} keyframes, {} voxels, hash {}, trajectory of {} poses",
                          map.poses.size(), voxels.size(), hash_text(voxels), poses));
  console.say((options.folder / "map.png").string());
}

int rebuild(const RebuildOptions& options, Console& console) {
  const DeskSettings settings = options.making.settings();
  refuse_without_map(options.folder);
  const FileLock lock = mapping::lock_folder(options.folder);
  const StoredMap map = read_map(options.folder, settings.mapper, console);
  const std::vector<StampedPose3> trajectory = trajectory_of(options.folder, map.poses);
  const VoxelMap& voxels = map.builder.map().occupied;
  MapFiles files(options.folder);
  files.write_views(map.builder.map(), trajectory);
  files.write_covariances(trajectory, map.poses.size());
  tell(options, map, trajectory.size(), console);
  files.write_octomap(settings.octomap, settings.localiser.threads, !options.making.no_octomap,
                      console);
  Summary summary = read_summary(options.folder).value_or(summary_of(map));
  describe(voxels, map.poses.size(), summary);
  files.write_summary(std::move(summary));
  return 0;
}

}  // namespace

void add_rebuild(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "rebuild",
      "Makes map.png, map.ply, map.bt, trajectory and summary anew from a map's keyframes.");
  const auto options = std::make_shared<RebuildOptions>();
  command->add_option("MAPDIR", options->folder, "map folder, as voxlist map or the mapper made it")
      ->required();
  options->making.add_to(*command);
  command->footer(
      "Example:\n"
      "  voxlist rebuild hall_map --octomap-resolution 0.05");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return rebuild(*options, console); };
  });
}

}  // namespace voxlist::desk
