#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/matching/search/pose_window.h"
#include "voxlist/matching/surfaces/evidence.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {

/// Scans with fewer points that tell poses apart than this match nothing: a handful of points fits
/// anywhere.
inline constexpr std::size_t kFewestMatchPoints = 50;

struct MatcherConfig {
  /// "search": certified branch and bound. "particle_filter": the paper's, for comparison (seconds
  /// a cloud).
  std::string engine = "search";
  /// Cell of the tolerant map and lattice of the poses (m) in a search of the whole map (doubled
  /// for scans that reach far); refinement goes on from there. Finer: fewer false modes, and the
  /// cube of the ratio slower.
  double resolution_m = 0.04;
  /// Points farther away than this take no part (m).
  double max_range_m = 60.0;
  /// Most points that a search counts, and that a refinement uses. Changes speed, and little else.
  int search_points = 500;
  int refine_points = 4000;
  /// Most nodes that a search opens before it gives up the certificate. Changes speed: 2 to 10 us
  /// each.
  int max_nodes = 100'000;

  template <class Visitor>
  void visit(Visitor& v) {
    v("engine", engine, "search (certified) or particle_filter (the paper's; seconds a cloud)");
    v("resolution_m", resolution_m,
      "lattice of poses in a search of the whole map; refined after that", 0.02, 1.0);
    v("max_range_m", max_range_m, "points farther away take no part in matching", 1.0, 500.0);
    v("search_points", search_points, "most points that a search counts: speed", 50, 1000);
    v("refine_points", refine_points, "most points that a refinement uses: speed", 50, 100000);
    v("max_nodes", max_nodes, "nodes after which a search gives up its certificate: speed", 100,
      100'000'000);
  }
};

/// A local best of the match, refined to the continuous optimum.
struct MatchMode {
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Before refinement.
  Pose2 start;
  /// Share of the points in occupied cells of the tolerant map, before refinement.
  double overlap = 0.0;
  /// Share of the points that lie on the map's surfaces, after refinement.
  double fit = 0.0;
  /// What the map says to the refined pose, and how much that speaks for it. Only after a search of
  /// the whole map.
  Evidence evidence;
  double support = 0.0;
};

struct Match {
  /// Best first, distinct in pose; empty when there is nothing to match. By support after a search
  /// of the whole map, by fit after others.
  std::vector<MatchMode> modes;
  /// No pose of the lattice overlaps more than the best found.
  bool certified = false;
  /// No mode of nearly as much overlap was left out for want of time.
  bool complete = false;
  /// What is not listed overlaps at most this share of what the best does; 1: who knows.
  double unseen = 1.0;
  std::int64_t poses_examined = 0;
  /// log10 significance of the best mode (paper, section IV) over all poses of the lattice.
  double significance_log10 = 0.0;
};

/// Matches scans with one map, whatever the engine.
class Matcher {
 public:
  virtual ~Matcher() = default;

  /// The modes of the pose of a scan (in base) within the window, or in the whole map without one.
  virtual Match match(const Cloud& scan, const std::optional<PoseWindow>& window) = 0;

  /// The same in the whole map, slower, with modes that overlap a good deal less: what else there
  /// is where one stands alone.
  virtual Match match_rivals(const Cloud& scan) { return match(scan, std::nullopt); }

  /// These blocks of the map have gained voxels or passed cells, and none have lost any. Matches
  /// are the same as with a new matcher.
  virtual void map_grew(const ChangedBlocks& grown) = 0;
};

/// Makes the map ready for matching, each part when it is first needed. The map must outlive the
/// matcher; after a change that map_grew() was not told of, make another one (debug builds abort
/// where one is missed; Localiser does it by itself). Use the matcher from one thread.
/// Throws std::invalid_argument on an unknown engine.
std::unique_ptr<Matcher> make_matcher(const OccupancyMap& map, const MatcherConfig& config);

}  // namespace voxlist::matching
