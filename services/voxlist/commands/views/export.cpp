#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/commands/settings.h"
#include "services/voxlist/commands/views/export_views.h"
#include "services/voxlist/commands/views/mcap_export.h"
#include "services/voxlist/output/console.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/io/files/atomic_file.h"
#include "voxlist/io/files/file.h"
#include "voxlist/mapping/keyframe_reader.h"
#include "voxlist/mapping/map_store.h"

namespace voxlist::desk {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  fs::path input;  // a map folder, or a log
  fs::path folder, mcap, config;
  PrefixOption prefix;
  ViewOptions views;
};

void make_empty_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure || !fs::is_directory(folder, failure))
    throw io::FileError(folder, "cannot be made a folder, check the name and its permissions");
  if (!fs::is_empty(folder, failure))
    throw io::FileError(folder, "is not empty, give a new folder for the scans");
}

// poses.csv. A map of several visits may hold times that go back, which no recording does: then the
// table tells none.
class Table {
 public:
  void add(const mapping::Keyframe& keyframe) {
    utimes_us_.push_back(keyframe.cloud.utime_us);
    const Eigen::Vector3d p = keyframe.T_map_base.translation();
    const Eigen::Quaterniond q(keyframe.T_map_base.linear());
    poses_.push_back(fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}", p.x(),
                                 p.y(), p.z(), q.x(), q.y(), q.z(), q.w()));
  }

  bool has_times() const {
    return std::ranges::adjacent_find(utimes_us_, std::greater_equal<>()) == utimes_us_.end();
  }

  std::string text() const {
    std::string text = has_times() ? "index,utime," : "index,";
    text += "x_m,y_m,z_m,qx,qy,qz,qw\n";
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const std::string time = has_times() ? fmt::format("{},", utimes_us_[i]) : "";
      text += fmt::format("{},{}{}\n", i, time, poses_[i]);
    }
    return text;
  }

  std::size_t size() const { return poses_.size(); }

 private:
  std::vector<std::int64_t> utimes_us_;
  std::vector<std::string> poses_;
};

int export_map(const ExportOptions& options, Console& console) {
  mapping::KeyframeReader reader(options.input / mapping::kKeyframeFile);
  make_empty_folder(options.folder);
  Table table;
  while (!stop_requested()) {
    const auto keyframe = reader.next();
    if (!keyframe) break;
    io::write_ply(options.folder / fmt::format("scan_{:04}.ply", table.size()), keyframe->cloud);
    table.add(*keyframe);
  }
  io::write_file_atomically(options.folder / "poses.csv", table.text());
  if (!reader.warning().empty()) console.warn(reader.warning());
  console.say(fmt::format("{}: {} scans with their poses", options.folder.string(), table.size()));
  if (!table.has_times())
    console.warn(
        "the keyframes' times go back, so poses.csv tells none: the scans are those of several "
        "visits");
  if (stop_requested()) console.warn("interrupted: the scans end there");
  return 0;
}

// A log as MCAP; of a map, views for planners where any is wanted, else the scans.
int run(const ExportOptions& options, Console& console) {
  if (!options.mcap.empty() && options.views.any())
    throw std::runtime_error("--mcap is of a log, the other views are of a map folder: give one");
  if (!options.mcap.empty())
    return export_mcap({options.input, options.mcap, options.prefix.of(options.config)}, console);
  if (!options.views.any()) return export_map(options, console);
  ViewOptions views = options.views;
  views.map = options.input;
  views.folder = options.folder;
  views.config = options.config;
  return export_views(views, console);
}

void add_options(CLI::App& command, ExportOptions& options) {
  command
      .add_option("INPUT", options.input,
                  "map folder, as voxlist map or the mapper made it; with --mcap an LCM log")
      ->required();
  CLI::Option_group* what = command.add_option_group("What");
  what->require_option(1);
  what->add_option("-o,--output", options.folder,
                   "folder to make of a map folder, scan_0000.ply and so on");
  what->add_option(
      "--mcap", options.mcap,
      "file to write of a log, for Foxglove, Lichtblick or Rerun: all messages as they "
      "were, and map, path, clouds, poses, obstacles, grids as those know them");
  command.add_option("--config", options.config,
                     "the robot's settings: its list [[robot]], and its prefix in a log");
  options.prefix.add_to(command);
  add_views(command, options.views);
}

}  // namespace

void add_export(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "export",
      "For other programs: a map's floor plan for each robot, distances, an OctoMap, or without "
      "any of these options its keyframes as scans with poses.csv; a log as MCAP.");
  const auto options = std::make_shared<ExportOptions>();
  add_options(*command, *options);
  command->footer(
      "Examples:\n"
      "  voxlist export hall_map -o plans --grid --config robot.toml\n"
      "  voxlist export hall_map -o hall_scans && \\\n"
      "    voxlist map hall_scans -o again --use-poses hall_scans/poses.csv\n"
      "  voxlist export run.lcm --mcap run.mcap");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return run(*options, console); };
  });
}

}  // namespace voxlist::desk
