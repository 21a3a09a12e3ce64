#pragma once

#include <Eigen/Core>
#include <vector>

#include "voxlist/drawing/map_layout.h"
#include "voxlist/drawing/picture.h"

namespace voxlist::drawing {

// What stands on and below every picture of a map, in colours that are the same in all of them.
inline constexpr io::Rgb kUnknown{14, 17, 23};  // also the background
inline constexpr io::Rgb kFree{48, 58, 76};
inline constexpr io::Rgb kInk{226, 230, 236};
inline constexpr io::Rgb kPath{255, 92, 72};
inline constexpr io::Rgb kStart{255, 255, 255};
inline constexpr double kTextSize = 20.0;
/// Half the height of a digit: moves the baseline so that text stands beside the middle of a mark.
inline constexpr double kHalfDigit = 0.36 * kTextSize;
/// Rows below a map for its marks.
inline constexpr int kFooter = 84;

/// A path with discs at its start and its end.
void draw_path(Picture& picture, const std::vector<Eigen::Vector2d>& pixels, double end_radius);

/// The path of a robot, seen from above.
void draw_path(Picture& picture, const MapLayout& layout, const std::vector<Eigen::Vector3d>& path);

/// A line that is 1, 2 or 5 times a power of ten long, with its length (m).
void draw_scale_bar(Picture& picture, const MapLayout& layout, double left, double y);

/// A disc of this colour, and what it means. Returns where the words end.
double draw_mark(Picture& picture, double x, double y, io::Rgb colour, const char* name);

/// The directions of the map's x and y.
void draw_axes(Picture& picture, const MapLayout& layout, const Eigen::Vector2d& centre);

/// Fills a square of the floor plan (m) where the layout shows all of it.
void fill_square(Raster& raster, const MapLayout& layout, const Eigen::Vector2d& centre,
                 double edge_m, io::Rgb colour);

}  // namespace voxlist::drawing
