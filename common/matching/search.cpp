#include "matching/search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <tuple>

namespace voxlist {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

// Poses [x, x + 2^level) x [y, y + 2^level) x angles [angle, angle + 2^level) of the lattice.
struct Node {
  int bound;
  int level;
  std::int32_t angle, x, y;

  // Priority: higher bound, then finer level, then position, so that the order never depends on
  // anything else.
  bool operator<(const Node& o) const {
    return std::tie(bound, o.level, o.angle, o.y, o.x) < std::tie(o.bound, level, angle, y, x);
  }
};

// The lattice of poses of one search, and the counting on it.
class Lattice {
 public:
  Lattice(const SearchMap& map, const MatchPoints& points, const PoseWindow& window)
      : map_(map),
        points_(points),
        step_m_(map.pyramid().resolution_m()),
        size_(1 << map.pyramid().top()) {
    const double finest_rad = step_m_ / std::max(points.radius_m, step_m_);
    const double half_yaw = std::min(window.half_yaw_rad, std::numbers::pi);
    const auto count = static_cast<std::int32_t>(std::ceil(2.0 * half_yaw / finest_rad)) + 1;
    angles_ = (count + size_ - 1) / size_ * size_;
    // The whole circle is divided evenly; a part of it keeps the finest step around its middle.
    yaw_step_rad_ = half_yaw == std::numbers::pi ? kTwoPi / angles_ : finest_rad;
    yaw0_rad_ = window.center.yaw_rad - yaw_step_rad_ * (angles_ - 1) / 2.0;
    const auto cells = [&](double half) {
      return static_cast<std::int32_t>(std::ceil(2.0 * half / step_m_)) + 1;
    };
    sweep_.nx = (cells(window.half_x_m) + size_ - 1) / size_;
    sweep_.ny = (cells(window.half_y_m) + size_ - 1) / size_;
    sweep_.x0 =
        static_cast<std::int32_t>(std::lround(window.center.x_m / step_m_)) - sweep_.nx * size_ / 2;
    sweep_.y0 =
        static_cast<std::int32_t>(std::lround(window.center.y_m / step_m_)) - sweep_.ny * size_ / 2;
  }

  // Bounds of all top-level nodes, by angle, y, x.
  std::vector<std::uint16_t> sweep_top() const {
    const auto per_angle =
        static_cast<std::size_t>(sweep_.nx) * static_cast<std::size_t>(sweep_.ny);
    const auto groups = static_cast<std::size_t>(angles_ / size_);
    std::vector<std::uint16_t> counts(groups * per_angle);
    tbb::parallel_for(std::size_t{0}, groups, [&](std::size_t g) {
      const auto cells = rotated_cells(static_cast<std::int32_t>(g) * size_, top_level());
      sweep_overlaps(map_.top(), cells, sweep_,
                     std::span(counts).subspan(g * per_angle, per_angle));
    });
    return counts;
  }

  Node top_node(std::size_t index, int bound) const {
    const auto nx = static_cast<std::size_t>(sweep_.nx), ny = static_cast<std::size_t>(sweep_.ny);
    return {bound, top_level(), static_cast<std::int32_t>(index / (nx * ny)) * size_,
            sweep_.x0 + static_cast<std::int32_t>(index % nx) * size_,
            sweep_.y0 + static_cast<std::int32_t>(index / nx % ny) * size_};
  }

  // The eight halves of a node, with their bounds.
  std::array<Node, 8> children(const Node& node) const {
    std::array<Node, 8> result;
    const int level = node.level - 1;
    const std::int32_t half = 1 << level;
    const BitGrid& grid = map_.pyramid().level(level);
    for (int a = 0; a < 2; ++a) {
      Node* child = &result[static_cast<std::size_t>(4 * a)];
      for (int i = 0; i < 4; ++i) {
        child[i] = {0, level, node.angle + a * half, node.x + (i & 1) * half,
                    node.y + (i >> 1) * half};
      }
      for (const Voxel& c : rotated_cells(node.angle + a * half, level)) {
        for (int i = 0; i < 4; ++i)
          child[i].bound += grid.test({c.x + child[i].x, c.y + child[i].y, c.z});
      }
    }
    return result;
  }

  // The pose in the middle of a node.
  Pose2 pose(const Node& node) const {
    const double middle = ((1 << node.level) - 1) / 2.0;
    return {(node.x + middle) * step_m_, (node.y + middle) * step_m_,
            wrap_angle(yaw0_rad_ + (node.angle + middle) * yaw_step_rad_)};
  }

  // How far a node's poses are from its middle.
  double radius_m(const Node& node) const {
    return ((1 << node.level) - 1) / 2.0 * step_m_ * std::numbers::sqrt2;
  }
  double radius_rad(const Node& node) const {
    return ((1 << node.level) - 1) / 2.0 * yaw_step_rad_;
  }

  int top_level() const { return map_.pyramid().top(); }
  std::int64_t top_count() const { return std::int64_t{angles_ / size_} * sweep_.nx * sweep_.ny; }

 private:
  std::vector<Voxel> rotated_cells(std::int32_t angle, int level) const {
    const double yaw = yaw0_rad_ + (angle + ((1 << level) - 1) / 2.0) * yaw_step_rad_;
    const double c = std::cos(yaw), s = std::sin(yaw);
    std::vector<Voxel> cells;
    cells.reserve(points_.points.size());
    for (const auto& p : points_.points) {
      cells.push_back(
          voxel_at(Eigen::Vector3d(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z()), step_m_));
    }
    return cells;
  }

  const SearchMap& map_;
  const MatchPoints& points_;
  double step_m_;
  std::int32_t size_;  // lattice steps along an edge of a top node
  std::int32_t angles_;
  double yaw_step_rad_, yaw0_rad_;
  SweepWindow sweep_;
};

// The best pose that a walk down from a node finds by always taking the best child.
Node dive(const Lattice& lattice, Node node) {
  while (node.level > 0) {
    const auto children = lattice.children(node);
    node = *std::max_element(children.begin(), children.end());
  }
  return node;
}

// The top nodes that may hold a mode, as a heap. What a walk down finds tells which bounds are too
// low to matter.
std::priority_queue<Node> open_top_nodes(const Lattice& lattice, double mode_ratio) {
  const auto bounds = lattice.sweep_top();
  const auto best =
      static_cast<std::size_t>(std::max_element(bounds.begin(), bounds.end()) - bounds.begin());
  const int found = dive(lattice, lattice.top_node(best, bounds[best])).bound;
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (bounds[i] > 0 && bounds[i] >= mode_ratio * found)
      nodes.push_back(lattice.top_node(i, bounds[i]));
  }
  return std::priority_queue<Node>(std::less<Node>(), std::move(nodes));
}

// Whether all poses within radius_m and radius_rad of a pose belong to a mode that is known
// already.
bool covered(const std::vector<OverlapMode>& modes, const Pose2& pose, double radius_m,
             double radius_rad, const SearchConfig& config) {
  return std::any_of(modes.begin(), modes.end(), [&](const OverlapMode& mode) {
    return distance_m(mode.pose, pose) + radius_m < config.mode_distance_m &&
           turn_rad(mode.pose, pose) + radius_rad < config.mode_turn_rad;
  });
}

}  // namespace

PoseWindow whole_map(const SearchMap& map) {
  const Pyramid& pyramid = map.pyramid();
  const double e = pyramid.resolution_m();
  const Voxel &low = pyramid.lowest(), &end = pyramid.end();
  return {{(low.x + end.x) * e / 2.0, (low.y + end.y) * e / 2.0, 0.0},
          (end.x - low.x) * e / 2.0,
          (end.y - low.y) * e / 2.0,
          std::numbers::pi};
}

SearchResult search(const SearchMap& map, const MatchPoints& points, const PoseWindow& window,
                    const SearchConfig& config) {
  SearchResult result;
  if (points.points.empty()) return result;
  const Lattice lattice(map, points, window);
  auto open = open_top_nodes(lattice, config.mode_ratio);
  result.poses_examined = lattice.top_count();
  result.lattice_poses =
      static_cast<double>(lattice.top_count()) * std::pow(8.0, lattice.top_level());
  std::int64_t expanded = 0;
  result.complete = true;
  while (!open.empty() && result.modes.size() < config.max_modes) {
    const Node node = open.top();
    open.pop();
    result.bound = result.modes.empty() ? node.bound : result.modes.front().overlap;
    if (!result.modes.empty() && node.bound < config.mode_ratio * result.bound) break;
    if (covered(result.modes, lattice.pose(node), lattice.radius_m(node), lattice.radius_rad(node),
                config))
      continue;
    if (node.level == 0) {
      result.modes.push_back({lattice.pose(node), node.bound});
      continue;
    }
    if (++expanded > config.max_nodes) {
      result.complete = false;
      break;
    }
    for (const Node& child : lattice.children(node)) open.push(child);
    result.poses_examined += 8;
  }
  result.certified = !result.modes.empty();
  return result;
}

}  // namespace voxlist
