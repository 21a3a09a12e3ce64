#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/matching/scan/match_points.h"
#include "voxlist/matching/scan/thinning.h"

namespace voxlist::matching {

/// Which points of a scan take part in matching.
struct ScanConfig {
  /// Points farther than this (m, horizontally) are left out: they would ask for finer angles than
  /// they repay.
  double max_range_m = 60.0;
  /// Most points that a refinement uses. Changes speed, and little else.
  int refine_points = 4000;
  /// Lowest and highest point (m above the floor) that takes part; empty: all do. A crowd hides
  /// walls and furniture, and leaves alone what is above its heads.
  std::vector<double> match_heights_m{};

  bool operator==(const ScanConfig&) const = default;

  template <class Visitor>
  void visit(Visitor& v) {
    v("max_range_m", max_range_m, "points farther away take no part in matching", 1.0, 500.0);
    v("refine_points", refine_points, "most points that a refinement uses: speed", 50, 100000);
    v("match_heights_m", match_heights_m,
      "[lowest, highest] point above the floor that takes part in matching, such as [1.9, 4.0] in "
      "crowds; [] for all",
      -100.0, 100.0);
  }
};

/// Throws std::invalid_argument where match_heights_m is no band.
void check(const ScanConfig& config);

/// One cloud with all that matching needs of it: made once for each cloud, and handed through. One
/// routine thins it, to one point of each cube (thinning.h); each part is made when it is first
/// asked for, and then kept. The cloud must outlive it. Use from one thread.
class PreparedScan {
 public:
  /// `floor_z_m`: the floor's height in the cloud's frame, for match_heights_m.
  explicit PreparedScan(const Cloud& cloud, const ScanConfig& config = {}, double floor_z_m = 0.0);
  PreparedScan(Cloud&&, const ScanConfig& = {}, double = 0.0) = delete;

  const Cloud& cloud() const { return cloud_; }

  /// How far most of the scan reaches (m), in few steps, at most max_range_m: maps are made ready
  /// for each step.
  double reach_m() const;

  /// For refinement: the points that tell poses (x, y, yaw) apart. Surfaces that lie flat are left
  /// out, unless nearly nothing else is there.
  const MatchPoints& points() const;

  /// For counting in a window, and for a first refinement: some of points(), spread as they are.
  const MatchPoints& few_points() const;

  /// For refinement of height, roll and pitch, too: as points(), floors and ceilings among them.
  MatchPoints spatial_points() const;

  /// How often a layer of that height (m) is to be doubled, at most `most` times, until most of
  /// points() have another one above, below or beside them in it: as high as a laser's rings are
  /// apart, so that the walls of a map of such scans have no holes.
  int layer_doublings(double height_m, int most) const;

  /// For a particle filter, which counts in voxels down to 0.02 m: as points(), from cubes of half
  /// the edge.
  std::vector<Eigen::Vector3f> filter_points() const;

  /// Indices of the cloud's points that are within range and the band of heights, and in the
  /// voxels' lattice. None where a lid covers the sensor: all points within 0.5 m.
  const std::vector<std::uint32_t>& in_range() const { return in_range_; }

  /// Those of in_range() that have other points about them: a search of the whole map asks about no
  /// others.
  const std::vector<std::uint32_t>& in_company() const;

  /// For a search of the whole map: of the points with these indices, which its map finds telling,
  /// one of each of the widest cubes that are enough. Surfaces count by their area, however many
  /// points lie on the near ones. All of them when there are few.
  std::vector<Eigen::Vector3f> search_points(const std::vector<std::uint32_t>& telling) const;

  /// Rays close together: what is near counts most, and so do small things in it.
  const std::vector<ScanRay>& near_rays() const;

  /// Rays spread evenly over all surfaces in sight.
  const std::vector<ScanRay>& even_rays() const;

  /// Fewer rays, spread in the same way: for what is asked at many poses, or of every scan.
  const std::vector<ScanRay>& few_rays() const;

 private:
  // Cubes of kFinestCube_m, twice and four times as wide.
  static constexpr std::size_t kLevels = 3;
  using Indices = std::vector<std::uint32_t>;

  const std::vector<InCube>& cubes(std::size_t level) const;
  std::vector<InCube> upright_cubes() const;
  MatchPoints taken(const Indices& indices) const;
  std::vector<ScanRay> lost_rays(std::size_t level) const;
  std::vector<ScanRay> rays(const Indices& indices) const;

  const Cloud& cloud_;
  const ScanConfig config_;
  const Indices in_range_;
  mutable std::array<std::optional<std::vector<InCube>>, kLevels> cubes_;
  mutable std::optional<Indices> in_company_;
  mutable std::optional<MatchPoints> points_, few_points_;
  mutable std::optional<std::vector<ScanRay>> near_rays_, even_rays_, few_rays_;
};

/// About every k-th of the points, so that at most `most` remain: spread as they are.
MatchPoints some_of(const MatchPoints& points, std::size_t most);

}  // namespace voxlist::matching
