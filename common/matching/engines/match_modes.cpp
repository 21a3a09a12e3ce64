#include "voxlist/matching/engines/match_modes.h"

#include <algorithm>

#include "voxlist/matching/engines/student.h"
#include "voxlist/matching/paper/significance.h"

namespace voxlist::matching {
namespace {

// Two refined poses nearer than this are one mode: about the reach of the refinement.
constexpr double kSameMode_m = 0.2;
constexpr double kSameMode_rad = 0.07;

// Candidates are ranked by ends of rays within this reach (m) of the map's things: half of what a
// pose is judged by, so that more sets the right one apart. With 0.08 m, 20 of 30 scans of a
// changed floor (60 x 40 m, seed 1) had a clear first mode, with 0.04 m 22.
constexpr double kRankReach_m = 0.04;

bool same_mode(const MatchMode& mode, const Pose2& pose) {
  return distance_m(mode.pose, pose) < kSameMode_m && turn_rad(mode.pose, pose) < kSameMode_rad;
}

template <class Refine>
std::vector<MatchMode> refined_by(const std::vector<MatchMode>& candidates, const Refine& refine) {
  std::vector<MatchMode> modes;
  for (MatchMode mode : candidates) {
    const Refinement refinement = refine(mode.pose);
    mode.pose = refinement.pose;
    mode.covariance = refinement.covariance;
    mode.inlier_ratio = refinement.inlier_ratio;
    if (!holds(modes, mode.pose)) modes.push_back(mode);
  }
  return modes;
}

// A prior as a pose so far from it has it, if errors have Student's distribution.
UncertainPose loosened(const UncertainPose& prior, const Pose2& pose) {
  return {prior.pose, prior.covariance * student_variance(mahalanobis2(pose, prior))};
}

}  // namespace

MatchMode candidate(const Pose2& pose, double overlap_ratio) {
  MatchMode mode;
  mode.pose = mode.start = pose;
  mode.overlap_ratio = overlap_ratio;
  return mode;
}

std::vector<MatchMode> candidates_of(const SearchResult& found, std::size_t points) {
  std::vector<MatchMode> candidates;
  for (const OverlapMode& mode : found.modes) {
    const double ratio = static_cast<double>(mode.overlap) / static_cast<double>(points);
    candidates.push_back(candidate(mode.pose, ratio));
  }
  return candidates;
}

bool holds(const std::vector<MatchMode>& modes, const Pose2& pose) {
  return std::any_of(modes.begin(), modes.end(),
                     [&](const MatchMode& mode) { return same_mode(mode, pose); });
}

std::vector<MatchMode> refined(const SurfelMap& surfels, const RayPoints& points,
                               const std::vector<MatchMode>& candidates,
                               const RefineConfig& config) {
  return refined_by(candidates,
                    [&](const Pose2& start) { return refine(surfels, points, start, config); });
}

std::vector<MatchMode> refined(const SurfelMap& surfels, const RayPoints& points,
                               const std::vector<MatchMode>& candidates, const UncertainPose& prior,
                               const RefineConfig& config) {
  return refined_by(candidates, [&](const Pose2& start) {
    return refine(surfels, points, start, loosened(prior, start), config);
  });
}

std::vector<MatchMode> held_by_surfaces(const SurfelMap& surfels, const RayPoints& points,
                                        const std::vector<MatchMode>& modes,
                                        const UncertainPose& prior) {
  return refined_by(modes, [&](const Pose2& start) {
    return refine(surfels, points, start, UncertainPose{start, prior.covariance}, RefineConfig{});
  });
}

void rank(const EvidenceMap& map, std::span<const ScanRay> rays, std::vector<MatchMode>& modes) {
  for (MatchMode& mode : modes) {
    mode.evidence = map.at(mode.pose, rays, kRankReach_m);
    mode.support = support_of(mode.evidence);
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const auto& a, const auto& b) { return a.support > b.support; });
}

void weigh_on_surfaces(const EvidenceMap& map, const SurfelMap& surfels,
                       std::span<const ScanRay> rays, std::vector<MatchMode>& modes) {
  for (MatchMode& mode : modes) {
    mode.evidence = map.on_surfaces(mode.pose, rays, surfels);
    mode.support = support_of(mode.evidence);
  }
}

double log10_significance(std::int64_t volume, std::int64_t occupied, std::size_t points,
                          int overlap, double poses) {
  const ChanceModel model{volume, std::min(occupied, volume),
                          std::min(static_cast<std::int64_t>(points), volume)};
  return log10_best_of(log10_overlap_tail(model, overlap), std::max(1.0, poses));
}

}  // namespace voxlist::matching
