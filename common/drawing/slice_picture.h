#pragma once

#include <string>
#include <vector>

#include "voxlist/drawing/map_picture.h"
#include "voxlist/drawing/picture.h"

namespace voxlist::drawing {

/// A map cut at a height: the voxels and squares of its view are those there.
struct MapSlice {
  MapView view;
  /// Centres of squares, as large as the free ones, that somebody keeps blocked by hand (m).
  std::vector<Eigen::Vector2f> blocked;
  /// Stands above it.
  std::string title;
};

/// Draws slices of one place side by side, each the same piece of the floor plan: occupied voxels
/// and what is kept blocked are light, free squares slate, what is unknown black. 1540 pixels wide;
/// a scale bar, the axes and a legend stand at the bottom. Precondition: there is one.
Picture draw_slices(const std::vector<MapSlice>& slices);

}  // namespace voxlist::drawing
