#pragma once

#include <filesystem>

#include "services/voxlist/output/console.h"
#include "services/voxlist/report/page/page.h"

namespace voxlist::desk {

/// One's own run: what a map folder holds, and how far it is from the truth where that is given (a
/// table of poses; an empty path: not). Throws io::FileError.
Report map_report(const std::filesystem::path& folder, const std::filesystem::path& truth,
                  Console& console);

}  // namespace voxlist::desk
