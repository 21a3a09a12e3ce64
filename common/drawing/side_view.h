#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "voxlist/drawing/raster.h"

namespace voxlist::drawing {

/// A map from the side, below its picture from above: the same axis lies across, heights go up. As
/// high as the map is at the picture's scale, or squeezed where that would be more than 300 pixels.
class SideView {
 public:
  /// `points`: how far across each voxel lies (pixels), and its height (m).
  SideView(const std::vector<Eigen::Vector2d>& points, double pixels_per_m);

  /// The picture's height in pixels.
  int height() const { return height_; }

  /// The row of a height, from the top.
  double row(double height_m) const { return (high_m_ - height_m) * pixels_per_m_; }

  double low_m() const { return low_m_; }
  double high_m() const { return high_m_; }

  /// Draws the voxels in cells of so many pixels, brighter where more of them lie behind each
  /// other. `colour` is that of a height.
  Raster draw(int width, double cell_pixels, io::Rgb background,
              const std::function<io::Rgb(double height_m)>& colour) const;

 private:
  const std::vector<Eigen::Vector2d> points_;
  double low_m_ = 0.0, high_m_ = 1.0, pixels_per_m_ = 1.0;
  int height_ = 0;
};

}  // namespace voxlist::drawing
