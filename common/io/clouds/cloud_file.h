#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/io/clouds/colour.h"
#include "voxlist/io/files/file.h"

namespace voxlist::io {

/// Reads a scan from a .ply (ASCII or binary), .pcd (v0.7: ascii, binary, binary_compressed) or
/// .bin (of the KITTI data sets) file. Takes x, y, z (metres, any number type) and, where there,
/// origin_x, origin_y, origin_z; ignores the rest; drops points that are not finite. utime_us stays
/// 0. Throws FileError on another extension or on damage, before it allocates more than a small
/// multiple of the file's size (88-fold for compressed data).
Cloud read_cloud_file(const std::filesystem::path& path);

/// Writes a scan, with its origins where it has them, as binary PLY, atomically. Throws FileError.
void write_ply(const std::filesystem::path& path, const Cloud& cloud);

/// Writes coloured points (as many colours as points) as binary PLY, atomically, with a comment of
/// one line in its header where there is one. Throws FileError.
void write_ply(const std::filesystem::path& path, const std::vector<Eigen::Vector3f>& points,
               const std::vector<io::Rgb>& colours, const std::string& comment = {});

/// Colours from each point's height between the 1st and 99th percentile of all heights (viridis).
std::vector<io::Rgb> colours_by_height(const std::vector<Eigen::Vector3f>& points);

}  // namespace voxlist::io
