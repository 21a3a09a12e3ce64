#include "services/voxlist/commands/extend.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/maps/map_files.h"
#include "services/voxlist/maps/map_run.h"
#include "services/voxlist/maps/run_report.h"
#include "services/voxlist/maps/sessions/extended_map.h"
#include "services/voxlist/maps/stored_map.h"
#include "services/voxlist/output/progress.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/mapping/pieces/carried_scans.h"

namespace voxlist::desk {
namespace {

RunFigures place_all(ScanInput& input, MapRun& run, Console& console) {
  return carry_out(input, run, "extending", console, [&](Progress& progress) {
    while (auto scan = input.next()) {
      run.localise(*scan);
      progress.show(input.progress());
    }
    run.finish();
  });
}

void tell(const ExtendOptions& options, const VoxelMap& voxels, const RunFigures& figures,
          const ExtendedMap& map, Console& console) {
  console.say(fmt::format(
      "{} of {} scans placed ({} lost, {} ambiguous), {} keyframes added to {}, {} voxels, hash {}",
      figures.placed, figures.scans, figures.lost, figures.ambiguous, map.added(), map.were_there(),
      voxels.size(), hash_text(voxels)));
  if (const std::string loops = closed_loops(figures); !loops.empty()) console.say(loops);
  console.say((options.folder / "map.png").string());
  if (figures.interrupted) console.warn("interrupted: the map ends there");
}

int tell_not_found(const ExtendOptions& options, const RunFigures& figures, Console& console) {
  console.warn(fmt::format(
      "{} was left as it was: none of the {} scans of {} was found in the map; a drive through "
      "places that it shows would help",
      options.folder.string(), figures.scans, figures.input));
  return kMostlyLost;
}

// Where the scans of all sessions were taken, those that were there first.
class Trajectory {
 public:
  Trajectory(const std::filesystem::path& folder, const ExtendedMap& map, const MapRun& run)
      : map_(map), before_(map.poses()), scans_(trajectory_of(folder, were_there(before_))) {
    were_there_ = scans_.size();
    const std::vector<StampedPose3> added = run.trajectory();
    scans_.insert(scans_.end(), added.begin(), added.end());
  }

  // The map's keyframes were moved since.
  std::vector<StampedPose3> moved() {
    const std::span<StampedPose3> scans(scans_);
    const std::span<const StampedPose3> before(before_), after(map_.poses());
    const std::size_t split = map_.were_there(), own = map_.added() > 0 ? split : 0;
    mapping::carry_scans(scans.first(were_there_), before.first(split), after.first(split));
    mapping::carry_scans(scans.subspan(were_there_), before.subspan(own), after.subspan(own));
    return scans_;
  }

 private:
  std::vector<StampedPose3> were_there(const std::vector<StampedPose3>& poses) const {
    return {poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(map_.were_there())};
  }

  const ExtendedMap& map_;
  const std::vector<StampedPose3> before_;
  std::vector<StampedPose3> scans_;
  std::size_t were_there_ = 0;
};

// All sessions together: what moved the map. Not where it was interrupted: then there may be little
// time.
std::optional<drawing::ClosedLoops> close_loops(ExtendedMap& map, const DeskSettings& settings,
                                                RunFigures& figures) {
  if (stop_requested()) return std::nullopt;
  const mapping::MapKeyframes before = map.keyframes();
  const mapping::SessionClosing closing = map.close(settings.localiser.matcher);
  figures.loops = static_cast<std::int64_t>(closing.loops);
  figures.loops_refused = static_cast<std::int64_t>(closing.refused);
  figures.loops_moved_m = closing.moved_m;
  return closing.moves ? std::optional(mapping::drawn(before, closing)) : std::nullopt;
}

void write(const ExtendOptions& options, const DeskSettings& settings, const OccupancyMap& made,
           const ExtendedMap& map, const std::vector<StampedPose3>& trajectory,
           const drawing::ClosedLoops& closed, const RunFigures& figures, Console& console) {
  const VoxelMap& voxels = made.occupied;
  MapFiles files(options.folder);
  files.write_views(made, trajectory, closed);
  files.write_covariances(trajectory, map.poses().size());
  tell(options, voxels, figures, map, console);
  files.write_octomap(settings.octomap, settings.localiser.threads, !options.making.no_octomap,
                      console);
  Summary summary = extended(read_summary(options.folder).value_or(Summary()), figures);
  describe(voxels, map.poses().size(), summary);
  files.write_summary(std::move(summary));
}

}  // namespace

int extend(const ExtendOptions& options, Console& console) {
  const DeskSettings settings = options.making.settings();
  refuse_without_map(options.folder);
  ScanInput input(options.input, console,
                  {settings.mapper.min_range_m, settings.mapper.max_range_m},
                  options.making.prefix.of(options.making.config), settings.adapter);
  ExtendedMap map(options.folder, settings.mapper, console);
  mapping::KeyframeSpool spool(options.folder);
  MapRun run(settings.localiser, settings.mapper, spool, map.take_builder(),
             [&map](const mapping::Keyframe& keyframe, const std::optional<Pose2>& T_odom_base) {
               map.append(keyframe, T_odom_base);
             });
  RunFigures figures = place_all(input, run, console);
  if (figures.placed == 0) return tell_not_found(options, figures, console);
  Trajectory trajectory(options.folder, map, run);
  const auto moved = close_loops(map, settings, figures);
  const mapping::MapBuilder rebuilt = moved ? map.rebuilt() : mapping::MapBuilder();
  const OccupancyMap& made = (moved ? rebuilt : run.builder()).map();
  write(options, settings, made, map, trajectory.moved(), moved.value_or(drawing::ClosedLoops()),
        figures, console);
  for (const std::string& line : {refused_loops(figures), shortfall(figures)})
    if (!line.empty()) console.warn(line);
  return 0;
}

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
      "Each keyframe is safe on the disk before the next one. At the end the loops of all "
      "sessions\n"
      "are closed together: graph.g2o tells where keyframes stand then.\n"
      "Exit code 3: none of the scans was found in the map, which is as it was.\n"
      "Example:\n"
      "  voxlist extend hall_map second_visit.lcm");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return extend(*options, console); };
  });
}

}  // namespace voxlist::desk
