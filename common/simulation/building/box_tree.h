#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace voxlist::simulation {

/// A solid block, turned about the vertical only. Metres.
struct Box {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();  ///< half its edges, before the turn
  double yaw_rad = 0.0;

  double bottom_m() const { return centre_m.z() - half_m.z(); }
  double top_m() const { return centre_m.z() + half_m.z(); }

  /// A point of the world in the box's own axes, from its centre.
  Eigen::Vector3d to_local(const Eigen::Vector3d& point) const;

  /// Horizontal distance of a point from the box's footprint: 0 on and inside it.
  double distance_m(const Eigen::Vector2d& point) const;

  /// Distance of a point from the box's surface, inside or outside.
  double surface_distance_m(const Eigen::Vector3d& point) const;

  /// Distance along a unit vector to the box: 0 from inside it; none when the ray misses.
  std::optional<double> range_m(const Eigen::Vector3d& origin,
                                const Eigen::Vector3d& direction) const;
};

/// Boxes in a binary tree of bounds, for ray casting.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> boxes);

  /// Distance along the unit vector `direction` to the first box hit: exact, 0 from inside a box;
  /// none when the ray leaves the world.
  std::optional<double> range(const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction) const;

  /// The boxes, in the tree's order.
  const std::vector<Box>& boxes() const { return boxes_; }

 private:
  // Children of an inner node: the one behind it in nodes_, and `right`. A leaf has right = 0.
  struct Node {
    Eigen::Array3d low, high;
    std::size_t begin, end, right;
  };

  void build(std::size_t begin, std::size_t end);

  std::vector<Box> boxes_;
  std::vector<Node> nodes_;
};

}  // namespace voxlist::simulation
