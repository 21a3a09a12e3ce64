#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/commands/settings.h"
#include "services/voxlist/maps/map_files.h"
#include "services/voxlist/maps/map_run.h"
#include "services/voxlist/maps/run_report.h"
#include "services/voxlist/maps/stored_map.h"
#include "services/voxlist/output/progress.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::desk {
namespace {

struct ExtendOptions {
  std::filesystem::path folder;
  std::filesystem::path input;
  MakingOptions making;
};

// The folder's map as it was, and the store that keyframes are added to.
class OpenMap {
 public:
  OpenMap(const std::filesystem::path& folder, const mapping::MapBuilderConfig& config,
          Console& console)
      : map_{mapping::MapBuilder(config), {}},
        store_(folder, 0, [this](mapping::Keyframe keyframe) { take(std::move(keyframe)); }) {
    if (!store_.notice().empty()) console.warn(store_.notice());
    if (map_.poses.empty())
      throw io::FileError(folder, "holds an empty map, make one with voxlist map");
  }
  OpenMap(const OpenMap&) = delete;
  OpenMap& operator=(const OpenMap&) = delete;

  StoredMap take_map() { return std::move(map_); }
  void append(const mapping::Keyframe& keyframe) { store_.append(keyframe); }

 private:
  void take(mapping::Keyframe keyframe) {
    map_.poses.push_back({keyframe.cloud.utime_us, keyframe.T_map_base});
    map_.builder.add(std::move(keyframe));
  }

  StoredMap map_;
  mapping::MapStore store_;
};

RunFigures place_all(ScanInput& input, MapRun& run, Console& console) {
  return carry_out(input, run, "extending", console, [&](Progress& progress) {
    while (auto scan = input.next()) {
      run.localise(*scan);
      progress.show(input.progress());
    }
    run.finish();
  });
}

void tell(const ExtendOptions& options, const MapRun& run, const RunFigures& figures,
          std::size_t added, Console& console) {
  const VoxelMap& map = run.builder().map().occupied;
  console.say(fmt::format(
      "{} of {} scans placed ({} lost, {} ambiguous), {} keyframes added to {}, {} voxels, hash {}",
      figures.placed, figures.scans, figures.lost, figures.ambiguous, added,
      run.builder().poses().size() - added, map.size(), hash_text(map)));
  console.say((options.folder / "map.png").string());
  if (figures.interrupted) console.warn("interrupted: the map ends there");
}

int extend(const ExtendOptions& options, Console& console) {
  const DeskSettings settings = options.making.settings();
  refuse_without_map(options.folder);
  ScanInput input(options.input, console,
                  {settings.mapper.min_range_m, settings.mapper.max_range_m},
                  options.making.prefix.of(options.making.config), settings.adapter);
  OpenMap open(options.folder, settings.mapper, console);
  StoredMap before = open.take_map();
  mapping::KeyframeSpool spool(options.folder);
  MapRun run(settings.localiser, settings.mapper, spool, std::move(before.builder),
             [&open](const mapping::Keyframe& keyframe) { open.append(keyframe); });
  const RunFigures figures = place_all(input, run, console);
  if (figures.placed == 0)
    throw io::FileError(options.folder, fmt::format("was left as it was: none of the {} scans of "
                                                    "{} was found in the map",
                                                    figures.scans, figures.input));
  std::vector<StampedPose3> trajectory = trajectory_of(options.folder, before.poses);
  const std::vector<StampedPose3> added = run.trajectory();
  trajectory.insert(trajectory.end(), added.begin(), added.end());
  MapFiles files(options.folder);
  const VoxelMap& voxels = run.builder().map().occupied;
  const std::size_t keyframes = run.builder().poses().size();
  files.write_views(voxels, trajectory);
  tell(options, run, figures, keyframes - before.poses.size(), console);
  files.write_octomap(settings.octomap, settings.localiser.threads, !options.making.no_octomap,
                      console);
  Summary summary = extended(read_summary(options.folder).value_or(Summary()), figures);
  describe(voxels, keyframes, summary);
  files.write_summary(std::move(summary));
  const std::string missing = shortfall(figures);
  if (!missing.empty()) console.warn(missing);
  return 0;
}

}  // namespace

void add_extend(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "extend", "Finds recorded scans in a map that is there, and adds what is new to it.");
  const auto options = std::make_shared<ExtendOptions>();
  command->add_option("MAPDIR", options->folder, "map folder, as voxlist map or the mapper made it")
      ->required();
  command
      ->add_option("INPUT", options->input, "LCM log with CLOUD (and ODOMETRY), or folder of scans")
      ->required();
  options->making.add_to(*command);
  command->footer(
      "Each keyframe is safe on the disk before the next one; nothing that was there is changed.\n"
      "Example:\n"
      "  voxlist extend hall_map second_visit.lcm");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return extend(*options, console); };
  });
}

}  // namespace voxlist::desk
