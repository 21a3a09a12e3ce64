#pragma once

#include <Eigen/Core>
#include <unordered_map>
#include <vector>

#include "voxels/voxel_map.h"

namespace voxlist {

/// A flat piece of a map's surface.
struct Surfel {
  /// Mean of the surface's voxels (m, map frame).
  Eigen::Vector3d mean;
  /// Unit normal, sign arbitrary.
  Eigen::Vector3d normal;
};

struct SurfelConfig {
  /// Edge of the cubes that are fitted with one plane each (m); rounded to whole blocks of the map.
  double cell_m = 0.32;
  /// Fewest voxels of a cube that make a surface.
  int min_voxels = 6;
  /// Largest standard deviation across a surface (m): rough and cluttered cubes are left out.
  double max_thickness_m = 0.06;
  /// Smallest ratio of the second-largest extent to the thickness: a line of points has no normal.
  double min_flatness = 2.5;
};

/// The flat surfaces of a map: one plane for each cube of voxels that is thin enough. Sums of voxel
/// coordinates are integers, so the planes depend on the set of voxels alone.
class SurfelMap {
 public:
  explicit SurfelMap(const VoxelMap& map, const SurfelConfig& config = {});

  /// The surfel of the cube that holds the point (m), or nullptr.
  const Surfel* find(const Eigen::Vector3d& point) const;

  std::size_t size() const { return surfels_.size(); }

 private:
  double cell_m_;
  struct Hash {
    std::size_t operator()(const Voxel& v) const;
  };
  std::unordered_map<Voxel, std::uint32_t, Hash> cells_;
  std::vector<Surfel> surfels_;
};

}  // namespace voxlist
