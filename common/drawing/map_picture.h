#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "voxlist/drawing/picture.h"

namespace voxlist::drawing {

/// A drive's loops that were closed, from above (map frame, m).
struct ClosedLoops {
  /// Both ends of each, where they stand now.
  std::vector<std::array<Eigen::Vector2d, 2>> loops;
  /// The keyframes' places before, in their order.
  std::vector<Eigen::Vector2d> before;
};

/// What a picture of a map shows (map frame, m). Each list may be empty.
struct MapView {
  /// Centres of occupied voxels, and their edge.
  std::vector<Eigen::Vector3f> occupied;
  double resolution_m = 0.02;
  /// Centres of squares of the floor plan above which space was seen to be free, and their edge.
  std::vector<Eigen::Vector2f> free;
  double free_m = 0.08;
  /// Where the robot was, oldest first.
  std::vector<Eigen::Vector3d> path;
  ClosedLoops closed;
};

/// Draws a voxel map from above, and below that from the side (side_view.h), so that ramps and
/// floors that lean are seen; with the path, its start and end, a scale bar and a legend of the
/// heights.
///
/// - From above ceilings are left out (map_columns.h says how), so that walls and what stands on
///   the floor are seen.
/// - The colour shows the height of the highest voxel that is left (io::viridis). The brightness
///   shows how many voxels lie above each other: walls are bright, floors are dim.
/// - Where no voxel is, space that was seen to be free is slate, and what is unknown is black.
/// - The picture is 1540 pixels wide and at most 1900 high. The map's longer side lies across; axes
///   at the bottom show which way it was turned.
/// - Loops are lines from end to end, and the path before they were closed is thin and grey.
/// - The outermost thousandth of the voxels is cut off on each side.
Picture draw_map(const MapView& view);

}  // namespace voxlist::drawing
