#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "voxlist/io/poses/pose_file.h"

namespace voxlist::io {

/// Poses in a file of rows of numbers without a header that must be read: TUM, KITTI, or EuRoC
/// without its header (see read_poses). Nothing when the file is a table with a header. Throws
/// FileError, with the line, on what is wrong in such a row.
std::optional<PoseTable> read_number_rows(const std::filesystem::path& path);

}  // namespace voxlist::io
