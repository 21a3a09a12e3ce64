#pragma once

#include <filesystem>

#include "services/voxlist/output/console.h"

namespace CLI {
class App;
}

namespace voxlist::desk {

/// What planners get of a map.
struct ViewOptions {
  std::filesystem::path map, folder, config;
  bool grid = false, scan = false, distance = false, octomap = false, tiles = false;
  double most_m = 2.0;  ///< up to which distances are told

  /// Whether any view is wanted.
  bool any() const { return grid || scan || distance || octomap; }
};

/// Adds options for the views to a command. They must outlive it.
void add_views(CLI::App& command, ViewOptions& views);

/// Writes the views into the folder, which is made if it is not there; files of the same name are
/// replaced. Returns the exit code. Throws FileError.
int export_views(const ViewOptions& options, Console& console);

}  // namespace voxlist::desk
