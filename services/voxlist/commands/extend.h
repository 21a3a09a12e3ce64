#pragma once

#include <filesystem>

#include "services/voxlist/commands/settings.h"

namespace voxlist::desk {

class Console;

/// A map folder, and what is to be added to it.
struct ExtendOptions {
  std::filesystem::path folder;
  std::filesystem::path input;
  MakingOptions making;
};

/// Finds recorded scans in a map that is there, and adds what is new to it. Returns the exit code:
/// 3, and the map is as it was, where none was found. Throws FileError.
int extend(const ExtendOptions& options, Console& console);

}  // namespace voxlist::desk
