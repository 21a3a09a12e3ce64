#pragma once

#include <filesystem>
#include <string>

#include "services/voxlist/output/console.h"

namespace voxlist::desk {

struct McapExport {
  std::filesystem::path log, file;
  /// The robot's, before each channel's name in the log.
  std::string prefix;
};

/// Writes a recording as an MCAP file: each message as it was, and what others' viewers know, as
/// they know it (foreign/foxglove). Returns the exit code; throws FileError.
int export_mcap(const McapExport& options, Console& console);

}  // namespace voxlist::desk
