#pragma once

#include <Eigen/Core>
#include <vector>

#include "voxlist/drawing/picture.h"
#include "voxlist/geometry/pose.h"

namespace voxlist::drawing {

/// Draws a voxel map from above, with a path, its start and end, a scale bar and a legend of the
/// heights.
///
/// `points` are the centres of occupied voxels (map frame, metres) of edge `resolution_m`; `path`
/// are poses in the same frame, oldest first. Either may be empty.
/// - Ceilings are left out (map_columns.h says how), so that walls and what stands on the floor are
///   seen.
/// - The colour shows the height of the highest voxel that is left (io::viridis). The brightness
///   shows how many voxels lie above each other: walls are bright, floors are dim.
/// - The picture is 1540 pixels wide and at most 1600 high. The map's longer side lies across; axes
///   at the bottom show which way it was turned.
/// - The outermost thousandth of the points is cut off on each side.
Picture draw_map(const std::vector<Eigen::Vector3f>& points, const std::vector<Pose2>& path,
                 double resolution_m);

}  // namespace voxlist::drawing
