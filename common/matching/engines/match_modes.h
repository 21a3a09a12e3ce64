#pragma once

#include <span>
#include <vector>

#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/search/search_result.h"
#include "voxlist/matching/surfaces/refine.h"
#include "voxlist/matching/surfaces/surfels.h"

// What all engines do with the poses that they have found.

namespace voxlist::matching {

/// A mode that is not refined yet.
MatchMode candidate(const Pose2& pose, double overlap_ratio);

/// A search's modes, to be refined. `points`: how many were counted.
std::vector<MatchMode> candidates_of(const SearchResult& found, std::size_t points);

/// Whether one of the modes is about at this pose.
bool holds(const std::vector<MatchMode>& modes, const Pose2& pose);

/// Refines candidates and keeps the distinct ones, in their order.
std::vector<MatchMode> refined(const SurfelMap& surfels, const RayPoints& points,
                               const std::vector<MatchMode>& candidates,
                               const RefineConfig& config = {});

/// The same where a prior is known. Candidates that it hardly allows are taken for what they are:
/// it holds these less, as where wheels slipped.
std::vector<MatchMode> refined(const SurfelMap& surfels, const RayPoints& points,
                               const std::vector<MatchMode>& candidates, const UncertainPose& prior,
                               const RefineConfig& config = {});

/// Refines modes that were found without a guess. Where the surfaces in sight hold them no better,
/// they are as vague as `prior`, wherever that expects them.
std::vector<MatchMode> held_by_surfaces(const SurfelMap& surfels, const RayPoints& points,
                                        const std::vector<MatchMode>& modes,
                                        const UncertainPose& prior);

/// Weighs modes by a scan's rays, and sorts them by their support, the best first.
void rank(const EvidenceMap& map, std::span<const ScanRay> rays, std::vector<MatchMode>& modes);

/// Weighs modes by a scan's rays and the map's surfaces (EvidenceMap::on_surfaces); their order
/// stays.
void weigh_on_surfaces(const EvidenceMap& map, const SurfelMap& surfels,
                       std::span<const ScanRay> rays, std::vector<MatchMode>& modes);

/// log10 significance of the best of `poses` poses (paper, section IV): `occupied` of `volume`
/// cells, and an overlap of that many of the points.
double log10_significance(std::int64_t volume, std::int64_t occupied, std::size_t points,
                          int overlap, double poses);

}  // namespace voxlist::matching
