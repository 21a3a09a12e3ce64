#pragma once

#include <vector>

#include "voxlist/matching/localisation/confidence.h"
#include "voxlist/matching/localisation/localisation.h"

namespace voxlist::matching {

/// The best even support that another pose than the candidate's has, or, if it is no candidate,
/// may have: the share `unseen` of the candidate's.
double rival_support(const PoseMode& candidate, const std::vector<PoseMode>& all, double unseen);

/// Hypotheses of where the robot is, as long as one scan alone cannot tell: each keeps what the
/// scans so far said for it, and moves with the robot. "None of them" is always one more
/// possibility.
class Hypotheses {
 public:
  /// `doubt`: logarithm of the odds by which every place is less probable from the start than what
  /// scans say for it.
  explicit Hypotheses(double doubt = 0.0) : doubt_(doubt) { clear(); }

  bool empty() const { return hypotheses_.empty(); }
  void clear();

  /// The robot has moved since the last scan (motion in base). Scans that are taken close together
  /// see nearly the same, and so count less.
  void move(const Pose2& motion);

  /// Where the hypotheses are now; covariances are the last scan's.
  std::vector<PoseMode> poses() const;

  /// Takes what a scan says (the support) of each candidate: hypotheses of before, found again
  /// about where they had moved to, and new ones. Hypotheses that no candidate is near are given
  /// up. `unseen`: a pose that is no candidate may have this share of a candidate's support.
  void update(const std::vector<PoseMode>& candidates, double unseen);

  /// Hypotheses with their probabilities, the most probable first; what is missing to 1 is for none
  /// of them.
  std::vector<PoseMode> modes() const;

 private:
  struct Hypothesis {
    PoseMode mode;
    LogOdds odds;
  };

  ScanWeight weight_of_scan() const;
  LogOdds past(const Pose2& pose) const;
  void keep_distinct(const std::vector<Hypothesis>& sorted);

  double doubt_;
  std::vector<Hypothesis> hypotheses_;
  // What scans said of a pose that none so far has listed.
  LogOdds unlisted_;
  double moved_m_ = 0.0;
};

}  // namespace voxlist::matching
