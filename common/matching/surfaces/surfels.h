#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

#include "voxlist/voxels/fast_cell.h"
#include "voxlist/voxels/numbering.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {

/// A flat piece of a map's surface.
struct Surfel {
  /// Mean of the surface's voxels (m, map frame).
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  /// Unit normal: out of the surface, to where rays passed; its sign is arbitrary when two_sided.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  /// Variance of the normal's direction (rad^2), by the scatter of the voxels.
  double tilt_variance = 0.0;
  /// Rays are known to have passed on both sides (a thin board), or on neither.
  bool two_sided = true;
  /// A plane through few voxels, of a small cube or of a large one that stands for emptier ones: by
  /// chance it may join what does not belong together, such as a column of a wall and the floor
  /// before it.
  bool of_few_voxels = false;
  /// Hardly wider than noise makes a line, such as a laser's ring or scan line leaves: it leans
  /// about the line by chance, mostly so that its plane holds the laser.
  bool of_line = false;

  /// Whether a ray from `origin` may have ended at `point` on this side of the surface.
  bool faces(const Eigen::Vector3d& origin, const Eigen::Vector3d& point) const {
    return two_sided || normal.dot(origin - point) > 0.0;
  }
};

struct SurfelConfig {
  /// Edge of the cubes that are fitted with planes (m); rounded to whole blocks of the map, 0.16 m.
  /// Scans that are found (bench_tracking 40 1, five cases): 92 to 100 % with 0.16 and
  /// with 0.64, all with 0.32. In smaller cubes fewer starts converge, larger ones hold corners and
  /// furniture, too.
  double cell_m = 0.32;
  /// Fewest voxels of a cube that make a surface: three make a plane, as many more tell its
  /// thickness. A judgement; 20 give the same errors within 0.05 mm (bench_tracking 40 1).
  int min_voxels = 6;
  /// Largest standard deviation across a surface (m), three times a scanner's noise of 0.02 m:
  /// rough and cluttered cubes are left out. 0.03 and 0.12 give the same errors within 0.15 mm
  /// (bench_tracking 40 1).
  double max_thickness_m = 0.06;
  /// Smallest ratio of the second-largest extent to the thickness, both standard deviations: a line
  /// of points has no normal. With 1, median errors grow by a tenth; with 6, too few surfaces are
  /// left, and up to 5 % of the scans are not found (bench_tracking 40 1).
  double min_flatness = 2.5;
};

/// The flat surfaces of a map: for each cube of voxels that is thin enough one plane, or two where
/// both faces of a thin wall are in it. Where a cube holds too few voxels for a plane, as where a
/// laser's rings lie far apart, the plane of a cube twice or four times as wide stands for it. Sums
/// of voxel coordinates are integers, so the planes depend on the map alone.
///
/// A cube is fitted when it is first asked for (about 2 us), so making one costs nothing; hence one
/// thread at a time, reading too.
class SurfelMap {
 public:
  /// The map must outlive it.
  explicit SurfelMap(const OccupancyMap& map, const SurfelConfig& config = {});

  /// The surfel of the cube that holds `point` that a ray from `origin` (both m, map frame) may
  /// have ended on, the nearest if there are two; nullptr when there is none. Stays where it is.
  const Surfel* find(const Eigen::Vector3d& point, const Eigen::Vector3d& origin) const {
    LookUp last;
    return find(point, origin, last);
  }

 private:
  struct Cube;

 public:
  /// Where a point was looked up last.
  struct LookUp {
    Voxel position;
    const Cube* cube = nullptr;
  };

  /// The same, quicker for a point that is mostly in the same cube as the time before.
  const Surfel* find(const Eigen::Vector3d& point, const Eigen::Vector3d& origin,
                     LookUp& last) const;

  /// To be called when the map has changed: cubes are fitted anew when next asked for. (All: a
  /// surfel depends on what rays passed round its cube, and a scan's rays pass most of what the
  /// next scan sees.) Surfels that were found before must not be used any more.
  void map_changed();

 private:
  struct Cube {
    bool fitted = false;
    int count = 0;
    Surfel sides[2];
    // Whose surfels stand for this cube's: its own, or those of a larger one about it.
    const Cube* speaker = nullptr;
  };
  // Of a cube's surfels the nearest that a ray from `origin` may have ended on.
  static const Surfel* nearest(const Cube& cube, const Eigen::Vector3d& point,
                               const Eigen::Vector3d& origin);
  // The cubes of one size, twice that of the level below.
  struct Level {
    std::int32_t blocks = 1;  // along a cube's edge
    Numbering<Voxel> positions;
    std::deque<Cube> cubes;  // by number of their position; a deque, so that they stay
  };

  Cube& cube_at(std::size_t level, const Voxel& position) const;
  std::vector<Voxel> voxels_of(std::size_t level, const Voxel& position) const;
  template <class Visit>
  void visit_small(const Voxel& position, const Visit& visit) const;
  template <class Visit>
  void visit_large(std::size_t level, const Voxel& position, const Visit& visit) const;
  void list_new_blocks() const;
  void fit(std::size_t level, const Voxel& position, Cube& cube) const;

  const OccupancyMap& map_;
  const SurfelConfig config_;
  double cubes_per_m_;    // smallest ones
  MapRevision revision_;  // of the map that the cubes were fitted in
  mutable std::array<Level, 3> levels_;
  // The map's blocks by the largest cube that they lie in: the numbers of each cube's, ascending by
  // layer, row and column. Larger cubes are mostly empty.
  mutable Numbering<Voxel> large_cubes_;
  mutable std::vector<std::vector<std::uint32_t>> blocks_in_;
  mutable std::size_t listed_ = 0;
};

inline const Surfel* SurfelMap::nearest(const Cube& cube, const Eigen::Vector3d& point,
                                        const Eigen::Vector3d& origin) {
  const Surfel* nearest = nullptr;
  double least_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i < cube.count; ++i) {
    const Surfel& side = cube.sides[i];
    const double off_m = std::abs(side.normal.dot(point - side.mean));
    if (off_m >= least_m || !side.faces(origin, point)) continue;
    nearest = &side;
    least_m = off_m;
  }
  return nearest;
}

// In the header, because a refinement calls it for each of its points, again and again.
inline const Surfel* SurfelMap::find(const Eigen::Vector3d& point, const Eigen::Vector3d& origin,
                                     LookUp& last) const {
  const Voxel position = cell_at(point, cubes_per_m_);
  if (!last.cube || position != last.position) last = {position, cube_at(0, position).speaker};
  return nearest(*last.cube, point, origin);
}

}  // namespace voxlist::matching
