#include "voxlist/simulation/building/box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "voxlist/geometry/elementary.h"

namespace voxlist::simulation {
namespace {

// Boxes in a leaf: fewer make the tree deeper, more make each leaf slower. The answer is the same.
constexpr std::size_t kLeafBoxes = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::Vector3d turned(const Eigen::Vector3d& v, double yaw_rad) {
  if (yaw_rad == 0.0) return v;
  const auto [s, c] = elementary::sine_cosine(yaw_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y(), v.z()};
}

Eigen::Array3d half_bounds(const Box& box) {
  const auto [sine, cosine] = elementary::sine_cosine(box.yaw_rad);
  const double c = std::abs(cosine), s = std::abs(sine);
  const Eigen::Vector3d& h = box.half_m;
  return {c * h.x() + s * h.y(), s * h.x() + c * h.y(), h.z()};
}

// Where the ray enters the slabs between low and high; infinity when it misses them.
double entry(const Eigen::Array3d& low, const Eigen::Array3d& high, const Eigen::Vector3d& origin,
             const Eigen::Vector3d& direction) {
  double near = 0.0, far = kInfinity;
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0.0) {
      if (origin[i] < low[i] || origin[i] > high[i]) return kInfinity;
      continue;
    }
    double in = (low[i] - origin[i]) / direction[i], out = (high[i] - origin[i]) / direction[i];
    if (in > out) std::swap(in, out);
    near = std::max(near, in);
    far = std::min(far, out);
  }
  return near <= far ? near : kInfinity;
}

double entry(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  return entry(-box.half_m.array(), box.half_m.array(), box.to_local(origin),
               turned(direction, -box.yaw_rad));
}

}  // namespace

Eigen::Vector3d Box::to_local(const Eigen::Vector3d& point) const {
  return turned(point - centre_m, -yaw_rad);
}

double Box::distance_m(const Eigen::Vector2d& point) const {
  const Eigen::Vector3d local = to_local({point.x(), point.y(), centre_m.z()});
  return (local.cwiseAbs() - half_m).cwiseMax(0.0).norm();
}

double Box::surface_distance_m(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d beyond = to_local(point).cwiseAbs() - half_m;
  const double deepest = beyond.maxCoeff();
  return deepest > 0.0 ? beyond.cwiseMax(0.0).norm() : -deepest;
}

std::optional<double> Box::range_m(const Eigen::Vector3d& origin,
                                   const Eigen::Vector3d& direction) const {
  const double range = entry(*this, origin, direction);
  return range < kInfinity ? std::optional(range) : std::nullopt;
}

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
  if (!boxes_.empty()) build(0, boxes_.size());
}

void BoxTree::build(std::size_t begin, std::size_t end) {
  const std::size_t self = nodes_.size();
  Node node{Eigen::Array3d::Constant(kInfinity), Eigen::Array3d::Constant(-kInfinity), begin, end,
            0};
  for (std::size_t i = begin; i < end; ++i) {
    node.low = node.low.min(boxes_[i].centre_m.array() - half_bounds(boxes_[i]));
    node.high = node.high.max(boxes_[i].centre_m.array() + half_bounds(boxes_[i]));
  }
  nodes_.push_back(node);
  if (end - begin <= kLeafBoxes) return;

  Eigen::Index axis = 0;
  (node.high - node.low).maxCoeff(&axis);
  std::stable_sort(
      boxes_.begin() + static_cast<std::ptrdiff_t>(begin),
      boxes_.begin() + static_cast<std::ptrdiff_t>(end),
      [axis](const Box& a, const Box& b) { return a.centre_m[axis] < b.centre_m[axis]; });
  const std::size_t middle = begin + (end - begin) / 2;
  build(begin, middle);
  nodes_[self].right = nodes_.size();
  build(middle, end);
}

std::optional<double> BoxTree::range(const Eigen::Vector3d& origin,
                                     const Eigen::Vector3d& direction) const {
  struct Candidate {
    std::size_t node;
    double entry;
  };
  const auto candidate = [&](std::size_t node) {
    return Candidate{node, entry(nodes_[node].low, nodes_[node].high, origin, direction)};
  };
  double nearest = kInfinity;
  Candidate stack[64];
  std::size_t depth = 0;
  if (!nodes_.empty()) stack[depth++] = candidate(0);
  while (depth > 0) {
    const Candidate at = stack[--depth];
    if (at.entry >= nearest) continue;
    const Node& node = nodes_[at.node];
    if (node.right == 0) {
      for (std::size_t i = node.begin; i < node.end; ++i)
        nearest = std::min(nearest, entry(boxes_[i], origin, direction));
    } else {  // the nearer child first
      Candidate near = candidate(at.node + 1), far = candidate(node.right);
      if (far.entry < near.entry) std::swap(near, far);
      stack[depth++] = far;
      stack[depth++] = near;
    }
  }
  return nearest < kInfinity ? std::optional(nearest) : std::nullopt;
}

}  // namespace voxlist::simulation
