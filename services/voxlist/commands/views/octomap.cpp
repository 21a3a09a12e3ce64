#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <vector>

#include "services/voxlist/commands/command.h"
#include "services/voxlist/commands/settings.h"
#include "services/voxlist/maps/octomap_of.h"
#include "services/voxlist/maps/stored_map.h"
#include "services/voxlist/output/stop.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

struct OctomapOptions {
  std::filesystem::path folder, output, config;
  double resolution_m = 0.0, voxel_m = 0.0;
  std::vector<double> box_m;
  int threads = 0;
};

void refuse_other_endings(const std::filesystem::path& output) {
  if (output.extension() == ".bt" || output.extension() == ".ot") return;
  throw io::FileError(output, "is neither .bt nor .ot, give a name that ends so");
}

int write(const OctomapOptions& options, Console& console) {
  planning::OctomapConfig config = read_settings(options.config).octomap;
  if (options.resolution_m > 0.0) {
    config.resolution_m = options.resolution_m;
    config.export_resolution_m = 0.0;
  }
  if (options.voxel_m > 0.0) config.export_resolution_m = options.voxel_m;
  if (!options.box_m.empty()) config.export_box_m = options.box_m;
  const planning::OctomapCut cut = planning::cut_of(config);
  refuse_other_endings(options.output);
  refuse_without_map(options.folder);
  const auto octomap = octomap_of(options.folder, config, options.threads, console);
  if (!octomap) {
    console.warn("interrupted: nothing was written");
    return kInterrupted;
  }
  if (options.output.extension() == ".bt")
    octomap->write_bt(options.output, cut);
  else
    octomap->write_ot(options.output, cut);
  console.say(options.output.string());
  return 0;
}

void add_options(CLI::App& command, OctomapOptions& options) {
  command.add_option("MAPDIR", options.folder, "map folder, as voxlist map or the mapper made it")
      ->required();
  command
      .add_option("-o,--output", options.output,
                  "file to write: .bt (free or occupied) or .ot (with log-odds)")
      ->required();
  command.add_option("--config", options.config, "robot.toml with a table [octomap_export]");
  command.add_option("--resolution", options.resolution_m, "edge of the smallest voxel (m)")
      ->check(CLI::Range(0.01, 10.0));
  command
      .add_option(
          "--voxels", options.voxel_m,
          "edge of the voxels of the file (m), above --resolution: occupied where a smaller "
          "one is, else free where one is")
      ->check(CLI::Range(0.01, 10.0));
  command.add_option("--box", options.box_m, "only what lies between two corners, x y z x y z (m)")
      ->expected(6)
      ->check(CLI::Range(-1e5, 1e5));
  command.add_option("--threads", options.threads, "most threads; the file does not depend on it")
      ->check(CLI::Range(1, 1024));
}

}  // namespace

void add_octomap(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand(
      "octomap", "Writes a map as an OctoMap, or a part of it, at any resolution.");
  const auto options = std::make_shared<OctomapOptions>();
  add_options(*command, *options);
  command->footer(
      "Example:\n"
      "  voxlist octomap hall_map -o room.ot --resolution 0.05 --box 0 0 0 8 6 3");
  command->callback([options, &chosen] {
    chosen = [options](Console& console) { return write(*options, console); };
  });
}

}  // namespace voxlist::desk
