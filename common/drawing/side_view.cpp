#include "voxlist/drawing/side_view.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace voxlist::drawing {
namespace {

constexpr double kMostPixels = 300.0;
constexpr double kMargin_m = 0.1;

// Stray points would take all the height: so large a share at each end is cut off.
constexpr double kOutliers = 0.001;

// One voxel has this share of its colour; so many behind each other take it two thirds of the way
// to the whole.
constexpr double kDim = 0.3, kMany = 8.0;

}  // namespace

SideView::SideView(const std::vector<Eigen::Vector2d>& points, double pixels_per_m)
    : points_(points) {
  std::vector<double> heights;
  for (const Eigen::Vector2d& point : points) heights.push_back(point.y());
  std::ranges::sort(heights);
  if (!heights.empty()) {
    const auto cut = static_cast<std::size_t>(kOutliers * static_cast<double>(heights.size() - 1));
    low_m_ = heights[cut] - kMargin_m;
    high_m_ = heights[heights.size() - 1 - cut] + kMargin_m;
  }
  pixels_per_m_ = std::min(pixels_per_m, kMostPixels / (high_m_ - low_m_));
  height_ = static_cast<int>(std::ceil((high_m_ - low_m_) * pixels_per_m_));
}

Raster SideView::draw(int width, double cell_pixels, io::Rgb background,
                      const std::function<io::Rgb(double height_m)>& colour) const {
  std::map<std::pair<int, int>, int> voxels;
  for (const Eigen::Vector2d& point : points_)
    ++voxels[{static_cast<int>(std::floor(point.x() / cell_pixels)),
              static_cast<int>(std::floor(row(point.y()) / cell_pixels))}];
  Raster raster(width, height_, background);
  for (const auto& [cell, n] : voxels) {
    const auto edge = [&](int i) { return static_cast<int>(std::lround(i * cell_pixels)); };
    const double many = 1.0 - std::exp(-n / kMany);
    const double height_m = high_m_ - (cell.second + 0.5) * cell_pixels / pixels_per_m_;
    raster.fill(edge(cell.first), edge(cell.second), edge(cell.first + 1), edge(cell.second + 1),
                io::mix(background, colour(height_m), kDim + (1.0 - kDim) * many));
  }
  return raster;
}

}  // namespace voxlist::drawing
