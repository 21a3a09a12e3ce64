#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "voxlist/geometry/cloud.h"

namespace voxlist::io {

/// What a scan's file tells of each point beside its place: time, ring, intensity, by the names of
/// its columns. Values of 8 bytes that are too great for a float (a time since 1970) are counted
/// from the first row's.
struct FurtherColumns {
  std::vector<std::string> names;
  /// As many values for each name as there are points.
  std::vector<std::vector<float>> values;
};

/// A scan as its laser told it: also the points that are not finite, in their order.
struct RawScan {
  Cloud cloud;
  FurtherColumns further;
};

/// Reads all of a .ply or .pcd file; otherwise as read_cloud_file.
RawScan read_raw_scan(const std::filesystem::path& path);

}  // namespace voxlist::io
