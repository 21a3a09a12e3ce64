#pragma once

#include <filesystem>

#include "services/voxlist/report/measured/scene.h"
#include "services/voxlist/report/page/entry.h"

namespace voxlist::desk {

inline constexpr const char* kRealScansId = "real-scans";
inline constexpr const char* kRealScansTitle = "The same on recorded scans";

/// Fig. 4, Fig. 6 and the best resolution on a folder of recorded scans with poses.csv: a map of 20
/// of them at these poses, and others that are found in it. Throws io::FileError.
Entry real_scans(const std::filesystem::path& folder, const Scene& scene);

}  // namespace voxlist::desk
