#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/voxels/edits/placed_box.h"
#include "voxlist/voxels/voxel_map.h"

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
  /// What is handed out: in larger voxels, or of a box alone.
  double export_resolution_m = 0.0;
  std::vector<double> export_box_m;

  template <class Visitor>
  void visit(Visitor& v) {
    v("resolution_m", resolution_m, "edge of the smallest voxel", 0.01, 10.0);
    v("max_range_m", max_range_m, "points farther away than this stay out, ray and all", 0.5,
      1000.0);
    v("min_range_m", min_range_m, "points nearer than this are no points, nor is 0,0,0", 0.0, 10.0);
    v("hit_probability", hit_probability, "that a voxel is occupied, after one hit", 0.51, 0.99);
    v("miss_probability", miss_probability, "that a voxel is occupied, after one pass", 0.01, 0.4);
    v("export_resolution_m", export_resolution_m,
      "edge of the voxels of OCTOMAP and the files, not below resolution_m; 0: that. One is "
      "occupied where a voxel in it is, else free where one is",
      0.0, 10.0);
    v("export_box_m", export_box_m,
      "only what lies between two corners, x, y, z, x, y, z in the map; empty: all", -1e5, 1e5);
  }
};

/// What an OctoMap knows of a place.
enum class Occupancy { kUnknown, kFree, kOccupied };

/// How much an OctoMap holds. Voxels are of the smallest size, whatever leaf stands for them.
struct OctomapSize {
  std::size_t free = 0;
  std::size_t occupied = 0;
  std::size_t nodes = 0;  ///< of the tree in a .bt file

  std::size_t known() const { return free + occupied; }
};

/// A cloud with its pose.
struct PosedCloud {
  Pose3 T_map_base = Pose3::Identity();
  Cloud cloud;
};

/// A cloud that is in an OctoMap, and where it belongs now; nowhere: it is taken out.
struct CloudMove {
  PosedCloud before;
  std::optional<Pose3> T_map_base;
};

/// Which part of an OctoMap is wanted, and how fine.
struct OctomapCut {
  /// Edge of the smallest voxel, not below the OctoMap's own; 0: that. A larger voxel is occupied
  /// where one of those in it is, else free where one is.
  double resolution_m = 0.0;
  /// Only what is in this box of the map's voxels; all where there is none.
  std::optional<VoxelBox> box;

  bool operator==(const OctomapCut&) const = default;
};

/// The part that the settings say. Throws std::invalid_argument where they make no sense.
OctomapCut cut_of(const OctomapConfig& config);

/// Builds an OctoMap from clouds with poses, every ray from where it started, cell by cell, without
/// OctoMap: by counters of hits and passes (voxels/counters), from which the files are written leaf
/// by leaf. It holds what OctoMap's insertPointCloud would hold: of the cells that either knows
/// more than 99.99 % are the same. The same clouds in the same order give the same bytes.
class OctomapBuilder {
 public:
  explicit OctomapBuilder(const OctomapConfig& config);
  ~OctomapBuilder();
  OctomapBuilder(OctomapBuilder&&) noexcept;
  OctomapBuilder& operator=(OctomapBuilder&&) noexcept;

  /// Adds a cloud: frees the voxels that its rays pass, occupies those that they hit; a voxel
  /// counts once a cloud, and one both hit and passed is hit, as in octomap's insertPointCloud.
  /// Rays that leave the tree's bounds (2^15 voxels from the origin) are left out. Where the rays
  /// of a cloud pass more than half a million blocks of 8 x 8 x 8 voxels, all are followed only so
  /// far, and every end point is kept. Asks `stopped`, where given, every few milliseconds; once it
  /// says yes the cloud is left out, and the answer is false.
  bool insert(const Pose3& T_map_base, const Cloud& cloud_base,
              const std::function<bool()>& stopped = {});

  /// Adds the clouds that `next` hands out, until it has none, as insert() does; up to `threads`
  /// (0: as many as there are processors) mark rays at once. `next` is asked by one thread at a
  /// time. The same bits for any number of threads. Once `stopped` says yes the answer is false,
  /// and what is in is of the first clouds.
  bool insert_all(const std::function<std::optional<PosedCloud>()>& next, int threads,
                  const std::function<bool()>& stopped = {});

  /// Takes clouds out, or moves them: the OctoMap is then that of the clouds that `all` hands out,
  /// which are those that are in, in the same order, where they belong now. Only what the moved
  /// clouds touch or touched is counted again, from the clouds that reach it: with all 89 keyframes
  /// of a hall at 0.1 m 2 ms each, 0.2 s. (Counters that could be subtracted would take four times
  /// the memory, and could not follow OctoMap's clamping, for which the order matters.) Answers as
  /// insert_all(); once it was false the OctoMap has to be made anew.
  bool recount(const std::vector<CloudMove>& moves,
               const std::function<std::optional<PosedCloud>()>& all, int threads,
               const std::function<bool()>& stopped = {});

  /// Takes boxes that were edited by hand in the place of those before: they come last, whatever is
  /// inserted. What is erased is unknown where it was occupied.
  void edit(const std::vector<PlacedBox>& boxes);

  /// The shortest distance that the rays of a cloud were followed to for their number's sake;
  /// infinite while all were followed to their ends.
  double reach_m() const;

  /// The bytes of a .bt file, as map_octree_t carries them: every voxel free or occupied, pruned.
  /// Costs what has changed since the last call, and the copying of the bytes; so does a part that
  /// is asked for again and again. Not from two threads at once.
  std::vector<std::uint8_t> binary(const OctomapCut& cut = {}) const;

  /// Writes a .bt file, never one that is half there. Throws FileError when it cannot.
  void write_bt(const std::filesystem::path& path, const OctomapCut& cut = {}) const;

  /// Writes an .ot file, every voxel with its log-odds, in the same way.
  void write_ot(const std::filesystem::path& path, const OctomapCut& cut = {}) const;

  OctomapSize size() const;

  /// What is known of the voxel that holds a point of the map.
  Occupancy at(const Eigen::Vector3d& point_map) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace voxlist::planning
