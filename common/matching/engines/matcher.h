#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/matching/scan/prepared_scan.h"
#include "voxlist/matching/search/pose_window.h"
#include "voxlist/matching/search/search_result.h"
#include "voxlist/matching/surfaces/evidence.h"
#include "voxlist/matching/surfaces/refine.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {

/// Scans with fewer points that tell poses apart than this match nothing: a handful of points fits
/// anywhere.
inline constexpr std::size_t kFewestMatchPoints = 50;

/// What finds poses.
enum class Engine {
  /// Certified branch and bound.
  kSearch,
  /// The paper's filter, for comparison: seconds a cloud.
  kParticleFilter,
};

/// Their names in a settings file.
inline constexpr std::array kEngineNames{"search", "particle_filter"};

struct MatcherConfig {
  Engine engine = Engine::kSearch;
  /// Cell of the dilated map and lattice of the poses (m) in a search of the whole map (doubled
  /// for scans that reach far); refinement goes on from there. Finer: fewer false modes, and the
  /// cube of the ratio slower.
  double resolution_m = 0.04;
  ScanConfig scan;
  /// Most points that a search counts. Changes speed, and little else.
  int search_points = 500;
  /// Most nodes that a search opens before it gives up the certificate. Changes speed: 2 to 10 us
  /// each.
  int max_nodes = kMostNodes;

  bool operator==(const MatcherConfig&) const = default;

  template <class Visitor>
  void visit(Visitor& v) {
    v("engine", engine, kEngineNames,
      "search (certified) or particle_filter (the paper's; seconds a cloud)");
    v("resolution_m", resolution_m,
      "lattice of poses in a search of the whole map; refined after that", 0.02, 1.0);
    scan.visit(v);
    v("search_points", search_points, "most points that a search counts: speed", 50, 1000);
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
  /// Counted points in occupied cells of the dilated map before refinement, as a share, 0..1.
  double overlap_ratio = 0.0;
  /// Points that lie on the map's surfaces after refinement, as a share, 0..1.
  double inlier_ratio = 0.0;
  /// What the map says to few_rays() at the pose, and how much that speaks for it. Not after a
  /// match in a window without a prior.
  Evidence evidence;
  double support = 0.0;
};

/// What a matcher found, and how far its search went. Certified and complete are told of the
/// lattice, before refinement.
struct Match : SearchReport {
  Match() = default;
  explicit Match(const SearchReport& report) : SearchReport(report) {}

  /// Best first, distinct in pose; empty when there is nothing to match. By support after a search
  /// of the whole map, by inlier ratio after others.
  std::vector<MatchMode> modes;
  /// A pose that is not listed overlaps at most this share of what the best does; 1: nobody knows.
  double unseen = 1.0;
  /// log10 significance of the best mode (paper, section IV) over all poses of the lattice.
  double significance_log10 = 0.0;
};

/// Matches scans with one map, whatever the engine.
class Matcher {
 public:
  virtual ~Matcher() = default;

  /// The modes of the pose of a scan (in base) within the window, or in the whole map without one.
  virtual Match match(const PreparedScan& scan, const std::optional<PoseWindow>& window) = 0;

  /// The modes within a window round `prior`, what is known by the motion since an earlier scan; in
  /// the whole map without one. In a window, the prior holds a pose where the map's surfaces do
  /// not, and is one of the candidates. In the whole map, poses are as vague as a prior that
  /// tells anything where surfaces do not hold them. Modes are weighed by on_surfaces().
  virtual Match track(const PreparedScan& scan, const std::optional<PoseWindow>& window,
                      const UncertainPose& prior) = 0;

  /// As track() in the whole map, slower, with modes that overlap a good deal less: what else there
  /// is where one stands alone.
  virtual Match track_rivals(const PreparedScan& scan, const UncertainPose& prior) {
    return track(scan, std::nullopt, prior);
  }

  /// The covariance of a pose that track() gave, if what may be single lines of a scan is left out
  /// of the map's surfaces: they seem to hold a pose where the map's scan that drew them was taken.
  virtual Eigen::Matrix3d covariance_without_lines(const PreparedScan& scan, const MatchMode& mode,
                                                   const UncertainPose& prior) = 0;

  /// A place beside a mode that track() gave, along a way that wheels may have slipped on, where
  /// the map explains the scan better than at the mode, by more than chance. Nothing where surfaces
  /// hold the mode along the way. `slip`: how far to each side (m).
  virtual std::optional<MatchMode> better_along(const PreparedScan&, const MatchMode&,
                                                const UncertainPose& /*prior*/,
                                                const Eigen::Vector2d& /*slip*/) {
    return std::nullopt;
  }

  /// As match() in the whole map, slower, with modes that overlap a good deal less: what else there
  /// is where one stands alone.
  virtual Match match_rivals(const PreparedScan& scan) { return match(scan, std::nullopt); }

  /// A pose near `start` by all six coordinates: where points, floors and ceilings among them, lie
  /// on the map's surfaces.
  virtual SpatialRefinement refined_in_space(const MatchPoints& points, const Pose3& start) = 0;

  /// What the map's voxels and surfaces say to rays at a pose (EvidenceMap::on_surfaces).
  virtual Evidence evidence_on_surfaces(const Pose2& T_map_base, std::span<const ScanRay> rays) = 0;

  /// The map, made ready for weighing poses.
  virtual const EvidenceMap& evidence() = 0;

  /// These blocks of the map have gained or lost voxels or passed cells. Matches are the same as
  /// with a new matcher.
  virtual void map_changed(const ChangedBlocks& changed) = 0;
};

/// Makes the map ready for matching, each part when it is first needed. The map must outlive the
/// matcher; after a change that map_changed() was not told of, make another one (debug builds abort
/// where one is missed; Localiser does it by itself). Use the matcher from one thread.
std::unique_ptr<Matcher> make_matcher(const OccupancyMap& map, const MatcherConfig& config);

}  // namespace voxlist::matching
