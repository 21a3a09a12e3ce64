#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "voxlist/geometry/pose.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist::matching {

/// A furnished room, its map at 0.02 m, and a scan taken in it: a seeded stand-in for real data.
struct SyntheticRoom {
  VoxelMap map;
  /// In base, at `truth` in the map.
  std::vector<Eigen::Vector3f> scan;
  Pose2 truth;
};

/// Points of the room's floor, walls and furniture (map frame), evenly spaced on each surface.
class RoomSurfaces {
 public:
  RoomSurfaces(double length_m, double depth_m, int furniture, unsigned seed) {
    const double height = 2.5;
    // Corner, two edges.
    add({0, 0, 0}, {length_m, 0, 0}, {0, depth_m, 0});
    add({0, 0, 0}, {length_m, 0, 0}, {0, 0, height});
    add({0, 0, 0}, {0, depth_m, 0}, {0, 0, height});
    add({length_m, 0, 0}, {0, depth_m, 0}, {0, 0, height});
    add({0, depth_m, 0}, {length_m, 0, 0}, {0, 0, height});
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random() % 1000) / 1000.0;
    };
    for (int i = 0; i < furniture; ++i) {
      const double yaw = between(0.0, 1.5), tall = between(0.4, 2.0),
                   x = between(0.5, length_m - 1.0);
      const Eigen::Vector3d corner(x, between(0.5, depth_m - 1.0), 0.0), up(0.0, 0.0, tall);
      const Eigen::Vector3d along = Pose2{0, 0, yaw} * Eigen::Vector3d(between(0.3, 1.2), 0.0, 0.0);
      const Eigen::Vector3d across =
          Pose2{0, 0, yaw} * Eigen::Vector3d(0.0, between(0.3, 0.8), 0.0);
      add(corner, along, up);
      add(corner, across, up);
      add(corner + along, across, up);
      add(corner + across, along, up);
      add(corner + up, along, across);
    }
  }

  /// Calls visit(point) for points `spacing_m` apart.
  template <class Visit>
  void sample(double spacing_m, Visit&& visit) const {
    for (const auto& s : surfaces_) {
      const double a_length = s.a.norm(), b_length = s.b.norm();
      for (double a = spacing_m / 2; a < a_length; a += spacing_m) {
        for (double b = spacing_m / 2; b < b_length; b += spacing_m) {
          visit(Eigen::Vector3d(s.corner + s.a * (a / a_length) + s.b * (b / b_length)));
        }
      }
    }
  }

 private:
  struct Surface {
    Eigen::Vector3d corner, a, b;
  };
  void add(const Eigen::Vector3d& corner, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    surfaces_.push_back({corner, a, b});
  }
  std::vector<Surface> surfaces_;
};

/// The room of a seed, scanned from `truth`: about `points` of all its surfaces within 8 m, none
/// hidden.
inline SyntheticRoom synthetic_room(double length_m, double depth_m, const Pose2& truth,
                                    std::size_t points, unsigned seed) {
  const RoomSurfaces surfaces(length_m, depth_m, 8, seed);
  SyntheticRoom room{VoxelMap(kFinestResolution_m), {}, truth};
  std::vector<Eigen::Vector3f> seen;
  const Pose2 T_base_map = truth.inverse();
  surfaces.sample(
      0.008, [&](const Eigen::Vector3d& p) { room.map.insert(voxel_at(p, kFinestResolution_m)); });
  surfaces.sample(0.037, [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d in_base = T_base_map * p;
    if (in_base.head<2>().norm() < 8.0) seen.push_back(in_base.cast<float>());
  });
  std::mt19937 random(seed + 1);
  for (std::size_t i = 0; i < points && !seen.empty(); ++i)
    room.scan.push_back(seen[random() % seen.size()]);
  return room;
}

}  // namespace voxlist::matching
