#pragma once

#include <Eigen/Core>
#include <vector>

#include "voxlist/drawing/picture.h"

namespace voxlist::drawing {

/// Draws a voxel map from above, and below that from the side (side_view.h), so that ramps and
/// floors that lean are seen; with a path, its start and end, a scale bar and a legend of the
/// heights.
///
/// `points` are the centres of occupied voxels (map frame, metres) of edge `resolution_m`; `path`
/// are places in the same frame, oldest first. Either may be empty.
/// - From above ceilings are left out (map_columns.h says how), so that walls and what stands on
/// the floor are
///   seen.
/// - The colour shows the height of the highest voxel that is left (io::viridis). The brightness
///   shows how many voxels lie above each other: walls are bright, floors are dim.
/// - The picture is 1540 pixels wide and at most 1900 high. The map's longer side lies across; axes
///   at the bottom show which way it was turned.
/// - The outermost thousandth of the points is cut off on each side.
Picture draw_map(const std::vector<Eigen::Vector3f>& points,
                 const std::vector<Eigen::Vector3d>& path, double resolution_m);

}  // namespace voxlist::drawing
