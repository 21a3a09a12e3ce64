#pragma once

#include <Eigen/Core>
#include <vector>

namespace voxlist::drawing {

/// A rectangle of the floor plan (map frame, m).
struct PlanBox {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Ones();
};

/// The values' `share` from below (0 to 1). Precondition: there are some.
double quantile(std::vector<double> values, double share);

/// The rectangle of a map that is worth drawing: all voxels but the outermost thousandth on each
/// side, and the whole path.
PlanBox extent(const std::vector<Eigen::Vector3f>& points,
               const std::vector<Eigen::Vector3d>& path);

/// Takes the map frame to pixels of a picture, with the map's longer side across.
class MapLayout {
 public:
  static constexpr int kMargin = 40;
  static constexpr double kMapPixels = 1460.0;
  /// A picture's width in pixels.
  static constexpr int kWidth = static_cast<int>(kMapPixels) + 2 * kMargin;

  /// A map of voxels of this edge (m), its longer side so many pixels long.
  MapLayout(const PlanBox& box, double resolution_m, double map_pixels = kMapPixels);

  /// A drawn cell is as wide as a voxel, or as several where a voxel is smaller than a pixel.
  double cell_m() const { return cell_m_; }
  double pixels_per_m() const { return pixels_per_m_; }

  /// The first row below the map.
  int bottom() const;

  Eigen::Vector2d pixel(const Eigen::Vector2d& p) const;
  bool shows(const Eigen::Vector2d& p) const;

 private:
  PlanBox box_;
  bool turned_;
  double pixels_per_m_;
  double cell_m_;
};

}  // namespace voxlist::drawing
