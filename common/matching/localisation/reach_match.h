#pragma once

#include <vector>

#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/matching/engines/matcher.h"

namespace voxlist::matching {

/// A match round a prediction, with the probabilities of its modes.
struct ReachMatch {
  /// Distinct places, the most probable first.
  Match match;
  /// That each mode is right; what is missing to 1 is for none of them: the scan is bad, or the
  /// robot elsewhere.
  std::vector<double> probabilities;

  double best() const { return probabilities.empty() ? 0.0 : probabilities.front(); }
};

/// A place in reach is sure from this probability on: TRACKING. At 0.99, one robot of 39 that were
/// carried away (bench_confidence, seed 141) passed for being where it was expected, at 0.991.
inline constexpr double kSureInReach = 0.995;

/// Where else a scan may have been taken.
enum class Rivals {
  /// Near the prediction, where the search sees to it that none is overlooked.
  kInReach,
  /// Anywhere: then what a search that was ended early did not look at counts.
  kAnywhere,
};

/// What lies within three standard deviations of a pose, and a little more.
PoseWindow window_about(const UncertainPose& pose);

/// Where within reach of a prediction a scan was taken: in a window round it, or in the whole map
/// where the prediction is too vague for one. There, even odds are the most that anything says for
/// the places found, and a place is sure only beside rivals that overlap a good deal less; unless
/// the prediction tells nothing, as between far-apart stations.
/// `in_reach`: the probability, before the scan is looked at, that it was taken there.
ReachMatch match_in_reach(Matcher& matcher, const PreparedScan& scan,
                          const UncertainPose& predicted, double in_reach,
                          Rivals rivals = Rivals::kInReach);

/// Asks the whole map for a place that explains a scan better than the best one in reach, and makes
/// those in reach as much less probable. Corridors look alike: a robot that was carried from one to
/// another may fit well enough where it was expected, and only the place where it is tells that it
/// is not there. `in_reach`: as above. Costs a search of the whole map.
void weigh_elsewhere(Matcher& matcher, const PreparedScan& scan, double in_reach,
                     ReachMatch& reach);

}  // namespace voxlist::matching
