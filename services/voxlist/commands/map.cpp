#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <future>
#include <memory>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/commands/extend.h"
#include "services/voxlist/commands/settings.h"
#include "services/voxlist/maps/map_files.h"
#include "services/voxlist/maps/map_run.h"
#include "services/voxlist/maps/run_report.h"
#include "services/voxlist/output/progress.h"
#include "services/voxlist/output/stop.h"
#include "services/voxlist/recording/given_poses.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::desk {
namespace {

struct MapOptions {
  std::filesystem::path input;
  std::filesystem::path folder;
  std::filesystem::path into;
  std::filesystem::path poses;
  MakingOptions making;
  bool force = false;
};

// Places all scans by themselves.
void localise_all(ScanInput& input, MapRun& run, Progress& progress) {
  while (auto scan = input.next()) {
    run.localise(*scan);
    progress.show(input.progress());
  }
  run.finish();
}

// Places the scans that the table knows. Returns how many it does not know.
std::int64_t place_all(const std::filesystem::path& table, const GivenPoses& poses,
                       ScanInput& input, MapRun& run, Progress& progress) {
  std::int64_t unknown = 0;
  while (auto scan = input.next()) {
    if (const auto pose = poses.of(*scan)) {
      scan->cloud.utime_us = pose->utime_us;
      run.place(std::move(*scan), pose->pose);
    } else {
      ++unknown;
    }
    progress.show(input.progress());
  }
  if (input.scans() > 0 && unknown == input.scans()) {
    throw io::FileError(table, "matches none of the scans, check its times, index or file column");
  }
  return unknown;
}

RunFigures make_map(const MapOptions& options, ScanInput& input, MapRun& run, Console& console) {
  if (options.poses.empty())
    return carry_out(input, run, "mapping", console,
                     [&](Progress& progress) { localise_all(input, run, progress); });
  const GivenPoses poses(options.poses, input, console);
  std::int64_t unknown = 0;
  RunFigures figures = carry_out(input, run, "mapping", console, [&](Progress& progress) {
    unknown = place_all(options.poses, poses, input, run, progress);
  });
  figures.offset_m = poses.offset_m();
  figures.without_pose = unknown;
  return figures;
}

void tell(const MapOptions& options, const MapRun& run, const RunFigures& figures,
          Console& console) {
  const double factor = figures.seconds / std::max(figures.elapsed_seconds, 1e-9);
  console.say(
      fmt::format("{} of {} scans placed ({} lost, {} ambiguous, {} without a pose), {} keyframes, "
                  "{} voxels, hash {}",
                  figures.placed, figures.scans, figures.lost, figures.ambiguous,
                  figures.without_pose, run.builder().poses().size(),
                  run.builder().map().occupied.size(), hash_text(run.builder().map().occupied)));
  console.say(fmt::format("{:.1f} s of data in {:.1f} s, {:.1f} times real time", figures.seconds,
                          figures.elapsed_seconds, factor));
  if (const std::string bias = odometry_bias(figures); !bias.empty()) console.say(bias);
  if (const std::string loops = closed_loops(figures); !loops.empty()) console.say(loops);
  console.say((options.folder / "map.png").string());
}

// A map that a robot made or added to may be the only one of its place.
void refuse_robots_map(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / mapping::kKeyframeFile) || is_of_one_run(folder)) return;
  throw io::FileError(folder,
                      "holds a map that a robot or voxlist extend made or added to: give another "
                      "folder, or --force to replace it");
}

// No scan was placed, or all were and there is still nothing to see.
bool tell_if_empty(const MapRun& run, Console& console) {
  if (!run.builder().map().empty()) return false;
  console.warn(run.trajectory().empty()
                   ? "the map is empty: no scan was placed"
                   : "the map is empty: no point of any scan lies between min_range_m and "
                     "max_range_m");
  return true;
}

void tell_shortfall(const RunFigures& figures, Console& console) {
  for (const std::string& line : {refused_loops(figures), shortfall(figures)})
    if (!line.empty()) console.warn(line);
}

void tell_floor(const RunFigures& figures, Console& console) {
  const std::string off = floor_is_off(figures);
  if (!off.empty()) console.warn(off);
}

int map(const MapOptions& options, Console& console) {
  const DeskSettings settings = options.making.settings();
  ScanInput input(options.input, console,
                  {settings.mapper.min_range_m, settings.mapper.max_range_m},
                  options.making.prefix.of(options.making.config), settings.adapter);
  if (!options.force) refuse_robots_map(options.folder);
  MapFiles files(options.folder);
  const FileLock lock = mapping::lock_folder(options.folder);
  mapping::KeyframeSpool spool(options.folder);
  MapRun run(settings.localiser, settings.mapper, spool);
  const RunFigures figures = make_map(options, input, run, console);
  const VoxelMap& voxels = run.builder().map().occupied;
  // The picture is drawn while keyframes are written and the OctoMap is made.
  const int threads = settings.localiser.threads;
  auto views = std::async(threads == 1 ? std::launch::deferred : std::launch::async, [&] {
    files.write_views(run.builder().map(), run.trajectory(), run.closed_loops());
  });
  files.write_keyframes(spool, run.keyframes(), voxels);
  files.write_graph(run.graph(), voxels);
  files.give_up_edits(console);
  files.write_scan_log(run.scan_log());
  tell(options, run, figures, console);
  if (figures.interrupted) console.warn("interrupted: the map ends there");
  files.write_octomap(settings.octomap, threads, !options.making.no_octomap, console);
  views.get();
  files.write_covariances(run.trajectory(), run.keyframes().size());
  Summary summary = summary_of(figures);
  describe(voxels, run.builder().poses().size(), summary);
  files.write_summary(std::move(summary));
  const bool is_empty = tell_if_empty(run, console);
  if (!is_empty) tell_shortfall(figures, console);
  tell_floor(figures, console);
  if (is_empty) return 1;
  return mostly_lost(figures) ? kMostlyLost : 0;
}

void add_options(CLI::App& command, MapOptions& options) {
  command
      .add_option("INPUT", options.input, "LCM log with CLOUD (and ODOMETRY), or folder of scans")
      ->required();
  CLI::Option_group* where = command.add_option_group("Where");
  where->require_option(1);
  where->add_option("-o,--output", options.folder, "map folder; its old map is replaced");
  CLI::Option* into =
      where->add_option("--into", options.into, "map folder whose map is extended: voxlist extend");
  command
      .add_option("--use-poses", options.poses,
                  "table of poses (poses.csv, or a file of TUM, KITTI or EuRoC) to put the scans "
                  "at, instead of localising them")
      ->excludes(into);
  command.add_flag("--force", options.force, "replace the folder's map also if a robot made it")
      ->excludes(into);
  options.making.add_to(command);
}

}  // namespace

void add_map(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "map", "Turns recorded scans into a map: the same input gives the same map, bit for bit.");
  const auto options = std::make_shared<MapOptions>();
  add_options(*command, *options);
  command->footer(
      "Writes trajectory.tum, trajectory_covariance.txt, graph.g2o, map.ply, map.png, map.bt,\n"
      "keyframes.voxlist, scans.csv, summary.json.\n"
      "--into MAPDIR: the same as voxlist extend MAPDIR INPUT.\n"
      "Exit code 3: less than half of the scans were placed; the last line says what would help.\n"
      "Examples:\n"
      "  voxlist map hall.lcmlog -o hall_map\n"
      "  voxlist map hall -o hall_map --use-poses hall/poses.csv --octomap-resolution 0.2");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) {
      if (options->into.empty()) return map(*options, console);
      return extend({options->into, options->input, options->making}, console);
    };
  });
}

}  // namespace voxlist::desk
