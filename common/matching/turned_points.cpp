#include "matching/turned_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxlist {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

}  // namespace

TurnedPoints::TurnedPoints(const TolerantMap& map, std::span<const Eigen::Vector3f> points)
    : map_(map) {
  double radius_m = map.cell_m();
  for (const auto& p : points) {
    const std::int32_t z = map.layer(static_cast<double>(p.z()));
    if (z < 0 || z >= map.size_z()) continue;
    points_.emplace_back(p.x(), p.y());
    layers_.push_back(z);
    radius_m = std::max(radius_m, std::hypot(double(p.x()), double(p.y())));
  }
  groups_ = static_cast<std::int32_t>(std::ceil(kTwoPi * radius_m / map.cell_m() / kGroup));
  cells_.resize(index(angles(), 0));
  places_.resize(cells_.size());
  boxes_.resize(static_cast<std::size_t>(angles()));
}

double TurnedPoints::yaw_rad(std::int32_t angle) const { return kTwoPi * angle / angles(); }

void TurnedPoints::turn(std::int32_t group) {
  for (std::int32_t angle = group * kGroup; angle < (group + 1) * kGroup; ++angle) {
    const auto c = static_cast<float>(std::cos(yaw_rad(angle)) / map_.cell_m());
    const auto s = static_cast<float>(std::sin(yaw_rad(angle)) / map_.cell_m());
    constexpr std::int16_t kFar = 32767;
    Box box{{kFar, kFar}, {-kFar, -kFar}};
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const float x = points_[i].x(), y = points_[i].y();
      const Cell cell{static_cast<std::int16_t>(std::floor(c * x - s * y)),
                      static_cast<std::int16_t>(std::floor(s * x + c * y))};
      box.low = {std::min(box.low.x, cell.x), std::min(box.low.y, cell.y)};
      box.high = {std::max(box.high.x, cell.x), std::max(box.high.y, cell.y)};
      cells_[index(angle, i)] = cell;
      places_[index(angle, i)] = static_cast<std::int32_t>(map_.place(cell.x, cell.y, layers_[i]));
    }
    boxes_[static_cast<std::size_t>(angle)] = box;
  }
}

std::vector<CoarseCell> TurnedPoints::coarse_cells(std::int32_t group, const CoarseMap& map) const {
  std::vector<std::int64_t> bits;
  bits.reserve(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    Cell low = cells_[index(group * kGroup, i)], high = low;
    for (std::int32_t a = 1; a < kGroup; ++a) {
      const Cell& cell = cells_[index(group * kGroup + a, i)];
      low = {std::min(low.x, cell.x), std::min(low.y, cell.y)};
      high = {std::max(high.x, cell.x), std::max(high.y, cell.y)};
    }
    // Beyond 16 cells from the coarse cell's start at the node's last translation.
    constexpr std::int32_t kFactor = CoarseMap::kFactor;
    const std::int32_t x = floor_div(low.x, kFactor), y = floor_div(low.y, kFactor);
    bits.push_back(
        map.bit(high.x - x * kFactor > kFactor, high.y - y * kFactor > kFactor, x, y, layers_[i]));
  }
  std::sort(bits.begin(), bits.end());
  std::vector<CoarseCell> cells;
  for (const std::int64_t bit : bits) {
    if (cells.empty() || cells.back().bit != bit) cells.push_back({bit, 0});
    ++cells.back().weight;
  }
  return cells;
}

}  // namespace voxlist
