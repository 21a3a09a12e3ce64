#include "voxlist/matching/engines/matcher.h"

#include "voxlist/matching/engines/along_way.h"
#include "voxlist/matching/engines/filter_matcher.h"
#include "voxlist/matching/engines/global_matcher.h"
#include "voxlist/matching/engines/match_modes.h"
#include "voxlist/matching/engines/window_matcher.h"

namespace voxlist::matching {
namespace {

// A prior that is vaguer than this (m), as half a minute without odometry makes it, tells nothing:
// then the search of the whole map alone says where the scan was taken. A judgement.
constexpr double kVaguest_m = 20.0;

Eigen::Vector3d unit(const Eigen::Vector2d& way) {
  return Eigen::Vector3d(way.x(), way.y(), 0.0).normalized();
}

// A covariance that is known anew along a way.
Eigen::Matrix3d with_sigma(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& way,
                           double sigma_m) {
  const Eigen::Matrix3d along = way * way.transpose(), beside = Eigen::Matrix3d::Identity() - along;
  return beside * covariance * beside + sigma_m * sigma_m * along;
}

class SearchMatcher : public Matcher {
 public:
  SearchMatcher(const OccupancyMap& map, const MatcherConfig& config)
      : map_(map), surfels_(map), global_(map, surfels_, config), window_(map, surfels_) {}

  Match match(const PreparedScan& scan, const std::optional<PoseWindow>& window) override {
    return window ? window_.match(scan, *window) : global_.match(scan, evidence());
  }

  Match track(const PreparedScan& scan, const std::optional<PoseWindow>& window,
              const UncertainPose& prior) override {
    if (!window) return tracked(scan, prior, global_.match(scan, evidence()));
    Match match = window_.track(scan, *window, prior);
    weigh_on_surfaces(evidence(), surfels_, scan.few_rays(), match.modes);
    return match;
  }

  Match track_rivals(const PreparedScan& scan, const UncertainPose& prior) override {
    return tracked(scan, prior, global_.match_rivals(scan, evidence()));
  }

  Eigen::Matrix3d covariance_without_lines(const PreparedScan& scan, const MatchMode& mode,
                                           const UncertainPose& prior) override {
    return matching::covariance_without_lines(surfels_, scan.points(), mode.pose, prior.covariance);
  }

  std::optional<MatchMode> better_along(const PreparedScan& scan, const MatchMode& mode,
                                        const UncertainPose& prior,
                                        const Eigen::Vector2d& slip) override {
    // All rays: a door or two are told by few of them.
    const auto& rays = scan.even_rays();
    const auto place = matching::better_along(evidence(), surfels_, rays, mode.pose,
                                              evidence_on_surfaces(mode.pose, rays), slip);
    if (!place || holds_along(scan, mode, prior, slip)) return std::nullopt;
    const Eigen::Matrix3d covariance = with_sigma(prior.covariance, unit(slip), place->sigma_m);
    std::vector<MatchMode> better =
        held_by_surfaces(surfels_, scan.points(), {candidate(place->pose, mode.overlap_ratio)},
                         {place->pose, covariance});
    weigh_on_surfaces(evidence(), surfels_, scan.few_rays(), better);
    return better.front();
  }

  Match match_rivals(const PreparedScan& scan) override {
    return global_.match_rivals(scan, evidence());
  }

  SpatialRefinement refined_in_space(const MatchPoints& points, const Pose3& start) override {
    return refine(surfels_, points, start);
  }

  Evidence evidence_on_surfaces(const Pose2& pose, std::span<const ScanRay> rays) override {
    return evidence().on_surfaces(pose, rays, surfels_);
  }

  const EvidenceMap& evidence() override {
    if (!evidence_) evidence_.emplace(map_);
    return *evidence_;
  }

  void map_changed(const ChangedBlocks& changed) override {
    surfels_.map_changed();
    global_.map_changed();
    window_.map_changed(changed);
    if (evidence_) evidence_->map_changed(changed);
  }

 private:
  // Whether surfaces hold a mode along a slip, lines left out.
  bool holds_along(const PreparedScan& scan, const MatchMode& mode, const UncertainPose& prior,
                   const Eigen::Vector2d& slip) {
    UncertainPose loose = prior;
    loose.covariance.topLeftCorner<2, 2>() += slip * slip.transpose();
    const Eigen::Vector3d way = unit(slip);
    const double variance = way.dot(covariance_without_lines(scan, mode, loose) * way);
    return variance < kHeld_m * kHeld_m;
  }

  // What was found in the whole map, as a prior has it.
  Match tracked(const PreparedScan& scan, const UncertainPose& prior, Match match) {
    if (worst_sigma_m(prior.covariance) < kVaguest_m)
      match.modes = held_by_surfaces(surfels_, scan.points(), match.modes, prior);
    weigh_on_surfaces(evidence(), surfels_, scan.few_rays(), match.modes);
    return match;
  }

  const OccupancyMap& map_;
  SurfelMap surfels_;
  std::optional<EvidenceMap> evidence_;
  GlobalMatcher global_;
  WindowMatcher window_;
};

}  // namespace

std::unique_ptr<Matcher> make_matcher(const OccupancyMap& map, const MatcherConfig& config) {
  switch (config.engine) {
    case Engine::kParticleFilter:
      return make_filter_matcher(map, config);
    case Engine::kSearch:
      break;
  }
  return std::make_unique<SearchMatcher>(map, config);
}

}  // namespace voxlist::matching
