#pragma once

#include <optional>
#include <vector>

#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/search/pose_window.h"

namespace voxlist::matching {

/// Sorts the modes of a match in reach of a prediction (Matcher::track) by what speaks for each,
/// how scan and map agree and how near the prediction is, the best first, and gives their
/// probabilities. What is missing to 1 is for none of them: the scan is bad, or the robot somewhere
/// else. `in_reach`: the probability, before the scan is looked at, that one of them is right.
/// `window`: what was searched; nothing: the whole map. Coefficients were fitted by
/// tests/bench/fits/fit_places.py. A place that is not listed may have the share `unseen` of the
/// best one's support.
std::vector<double> rank_in_reach(const UncertainPose& predicted,
                                  const std::optional<PoseWindow>& window, double in_reach,
                                  std::vector<MatchMode>& modes, double unseen = 0.0);

/// The odds between two places by how well each explains a scan, wherever the robot was expected:
/// above 1 where the first one explains it better.
double odds_between(const MatchMode& place, const MatchMode& other);

}  // namespace voxlist::matching
