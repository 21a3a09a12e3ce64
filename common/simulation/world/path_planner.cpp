#include "voxlist/simulation/world/path_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "voxlist/geometry/elementary.h"

namespace voxlist::simulation {
namespace {

using Eigen::Vector2d;
using Path = std::vector<Vector2d>;

// A wheel rolls over what is lower than this (m).
constexpr double kFloorThickness_m = 0.02;

// Clearance beyond which more is not better (m), and the price of a metre with none to spare: so
// ways prefer the middle of free space, but not at three times the length.
constexpr double kComfort_m = 0.4, kTightCost = 3.0;

}  // namespace

PathPlanner::PathPlanner(const Building& building, const TourConfig& config)
    : cell_m_(config.cell_m) {
  Vector2d high = low_;
  for (const Box& box : building.solid.boxes()) {
    const double reach = box.half_m.head<2>().norm();
    low_ = low_.cwiseMin((box.centre_m.head<2>().array() - reach).matrix());
    high = high.cwiseMax((box.centre_m.head<2>().array() + reach).matrix());
  }
  // Points of the grid lie on multiples of the cell: the origin, where the tour starts, is one.
  low_ = (low_ / cell_m_).array().floor() * cell_m_;
  nx_ = 1 + static_cast<int>((high.x() - low_.x()) / cell_m_);
  ny_ = 1 + static_cast<int>((high.y() - low_.y()) / cell_m_);
  const double needed = config.robot_radius_m + config.margin_m;
  for (int i = 0; i < nx_ * ny_; ++i) {
    const double spare =
        building.clearance_m(point(i), kFloorThickness_m, config.robot_height_m) - needed;
    price_.push_back(spare < 0.0 ? std::numeric_limits<double>::infinity()
                                 : 1.0 + kTightCost * std::max(0.0, 1.0 - spare / kComfort_m));
  }
}

Path PathPlanner::path(const Vector2d& from, const Vector2d& to) const {
  const int start = index(from), goal = index(to);
  std::vector<double> cost(price_.size(), std::numeric_limits<double>::infinity());
  std::vector<int> parent(price_.size(), -1);
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>>
      open;
  cost[static_cast<std::size_t>(start)] = 0.0;
  open.emplace(0.0, start);
  while (!open.empty() && open.top().second != goal) {
    const int at = open.top().second;
    open.pop();
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int next = neighbour(at, dx, dy);
        if (next < 0) continue;
        const auto n = static_cast<std::size_t>(next);
        const double c =
            cost[static_cast<std::size_t>(at)] + cell_m_ * elementary::hypot(dx, dy) * price_[n];
        if (c >= cost[n]) continue;
        cost[n] = c;
        parent[n] = at;
        open.emplace(c + (point(next) - point(goal)).norm(), next);
      }
  }
  return open.empty() ? Path{} : trace(parent, start, goal);
}

Path PathPlanner::trace(const std::vector<int>& parent, int start, int goal) const {
  Path path;
  for (int at = goal; at != start; at = parent[static_cast<std::size_t>(at)])
    path.push_back(point(at));
  path.push_back(point(start));
  std::reverse(path.begin(), path.end());
  return path;
}

int PathPlanner::neighbour(int at, int dx, int dy) const {
  const int x = at % nx_ + dx, y = at / nx_ + dy;
  return x < 0 || x >= nx_ || y < 0 || y >= ny_ ? -1 : y * nx_ + x;
}

Vector2d PathPlanner::point(int i) const { return low_ + Vector2d(i % nx_, i / nx_) * cell_m_; }

int PathPlanner::index(const Vector2d& p) const {
  const Vector2d cell = ((p - low_) / cell_m_).array().round();
  return static_cast<int>(cell.y()) * nx_ + static_cast<int>(cell.x());
}

}  // namespace voxlist::simulation
