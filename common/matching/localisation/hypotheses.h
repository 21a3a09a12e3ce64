#pragma once

#include <vector>

#include "voxlist/matching/localisation/confidence.h"
#include "voxlist/matching/localisation/localisation.h"

namespace voxlist::matching {

/// The best even support that another place than the candidate's has, or, if it is no candidate,
/// may have: the share `unseen` of the candidate's.
double rival_support(const PoseMode& candidate, const std::vector<PoseMode>& all, double unseen);

/// Where the robot may be, as long as one scan alone cannot tell: each place keeps what the scans
/// so far said for it. Places move with the robot; "none of them" is always one more possibility.
class Hypotheses {
 public:
  bool empty() const { return places_.empty(); }
  void clear();

  /// The robot has moved since the last scan (motion in base). Scans that are taken close together
  /// see nearly the same, and so count less.
  void move(const Pose2& motion);

  /// Where the places are now; covariances are the last scan's.
  std::vector<PoseMode> places() const;

  /// Takes what a scan says (the support) of each candidate: places of before, found again about
  /// where they had moved to, and new ones. Places that no candidate is near are given up.
  /// `unseen`: a place that is no candidate may have this share of a candidate's support.
  void weigh(const std::vector<PoseMode>& candidates, double unseen);

  /// Candidates with their probabilities, the most probable first; what is missing to 1 is for none
  /// of them.
  std::vector<PoseMode> modes() const;

 private:
  struct Place {
    PoseMode mode;
    Odds odds;
  };

  Odds past(const Pose2& pose) const;

  std::vector<Place> places_;
  /// Of a place that no scan so far has listed.
  Odds unlisted_;
  double moved_m_ = 0.0;
};

}  // namespace voxlist::matching
