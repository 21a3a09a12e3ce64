#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"

namespace voxlist::planning {

/// What an OctoMap is made with. The probabilities are OctoMap's own defaults.
struct OctomapConfig {
  double resolution_m = 0.1;
  /// As the mapper's: memory and time of a cloud are bounded by it (100 points at 3 km took 1.4
  /// GB).
  double max_range_m = 100.0;
  double min_range_m = 0.05;
  double hit_probability = 0.7;
  double miss_probability = 0.4;

  template <class Visitor>
  void visit(Visitor& v) {
    v("resolution_m", resolution_m, "edge of the smallest voxel", 0.01, 10.0);
    v("max_range_m", max_range_m, "points farther away than this stay out, ray and all", 0.5,
      1000.0);
    v("min_range_m", min_range_m, "points nearer than this are no points, nor is 0,0,0", 0.0, 10.0);
    v("hit_probability", hit_probability, "that a voxel is occupied, after one hit", 0.51, 0.99);
    v("miss_probability", miss_probability, "that a voxel is occupied, after one pass", 0.01, 0.49);
  }
};

/// What an OctoMap knows of a place.
enum class Occupancy { kUnknown, kFree, kOccupied };

/// How much an OctoMap holds. Voxels are of the smallest size, whatever leaf stands for them.
struct OctomapSize {
  std::size_t free = 0;
  std::size_t occupied = 0;
  std::size_t nodes = 0;  ///< of the tree

  std::size_t known() const { return free + occupied; }
};

/// Builds an OctoMap from clouds with poses by OctoMap's own ray insertion, every ray from where it
/// started, cell by cell. Slow and right: the reference that faster ones are held
/// against. The same clouds in the same order give the same bytes.
class OctomapBuilder {
 public:
  explicit OctomapBuilder(const OctomapConfig& config);
  ~OctomapBuilder();
  OctomapBuilder(OctomapBuilder&&) noexcept;
  OctomapBuilder& operator=(OctomapBuilder&&) noexcept;

  /// Adds a cloud: frees the voxels that its rays pass, occupies those that they hit; a voxel
  /// counts once a cloud, and one both hit and passed is hit, as in octomap's insertPointCloud.
  /// Rays that leave the tree's bounds (2^15 voxels from the origin) are left out. Where the rays
  /// of a cloud pass more than a million voxels, all are followed only so far, and every end point
  /// is kept. Asks `stopped`, where given, every few milliseconds; once it says yes what is missing
  /// of the cloud is left out, and the answer is false.
  bool insert(const Pose3& T_map_base, const Cloud& cloud_base,
              const std::function<bool()>& stopped = {});

  /// The shortest distance that the rays of a cloud were followed to for their number's sake;
  /// infinite while all were followed to their ends.
  double reach_m() const;

  /// The bytes of a .bt file, as map_octree_t carries them: every voxel free or occupied, pruned.
  /// Costs what has changed since the last call, and the copying of the bytes. Not from two threads
  /// at once.
  std::vector<std::uint8_t> binary() const;

  /// Writes a .bt file, never one that is half there. Throws FileError when it cannot.
  void write_bt(const std::filesystem::path& path) const;

  /// Writes an .ot file, every voxel with its log-odds, in the same way.
  void write_ot(const std::filesystem::path& path) const;

  OctomapSize size() const;

  /// What is known of the voxel that holds a point of the map.
  Occupancy at(const Eigen::Vector3d& point_map) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace voxlist::planning
