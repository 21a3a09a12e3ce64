#include "voxlist/drawing/map_layout.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace voxlist::drawing {

using Eigen::Vector2d;

double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

PlanBox extent(const std::vector<Eigen::Vector3f>& points,
               const std::vector<Eigen::Vector3d>& path) {
  constexpr double kOutliers = 0.001;
  PlanBox box;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> values;
    for (const auto& p : points) {
      values.push_back(static_cast<double>(p[axis]));
    }
    if (!values.empty()) {
      box.low[axis] = quantile(values, kOutliers);
      box.high[axis] = quantile(values, 1.0 - kOutliers);
    }
  }
  for (const Eigen::Vector3d& place : path) {
    box.low = box.low.cwiseMin(place.head<2>());
    box.high = box.high.cwiseMax(place.head<2>());
  }
  const double margin = 0.01 * (box.high - box.low).maxCoeff() + 0.1;
  box.low.array() -= margin;
  box.high.array() += margin;
  return box;
}

MapLayout::MapLayout(const PlanBox& box, double resolution_m, double map_pixels) : box_(box) {
  const Vector2d size = box.high - box.low;
  turned_ = size.y() > size.x();
  pixels_per_m_ = map_pixels / size.maxCoeff();
  cell_m_ = resolution_m * std::ceil(1.0 / (resolution_m * pixels_per_m_));
}

int MapLayout::bottom() const {
  const Vector2d size = (box_.high - box_.low) * pixels_per_m_;
  return static_cast<int>(turned_ ? size.x() : size.y()) + kMargin;
}

Vector2d MapLayout::pixel(const Vector2d& p) const {
  const Vector2d across = turned_ ? Vector2d(p.y() - box_.low.y(), p.x() - box_.low.x())
                                  : Vector2d(p.x() - box_.low.x(), box_.high.y() - p.y());
  return (across * pixels_per_m_).array() + kMargin;
}

bool MapLayout::shows(const Vector2d& p) const {
  return (p.array() >= box_.low.array()).all() && (p.array() <= box_.high.array()).all();
}

}  // namespace voxlist::drawing
