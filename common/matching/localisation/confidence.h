#pragma once

#include <span>
#include <vector>

namespace voxlist::matching {

/// How well a scan and the map agree at a pose, at most 1 each.
struct PoseSupport {
  /// Support by rays close together: what is near counts most, and so do small things in it. Tells
  /// alike poses apart.
  double near = 0.0;
  /// Support by evenly spread rays: tells whether the pose can be right at all.
  double even = 0.0;
};

/// What scans say for and against a hypothesis, as sums of logarithms of odds.
struct LogOdds {
  /// Against other hypotheses: a difference of two sums is the logarithm of the odds between them.
  double among = 0.0;
  /// That the hypothesis is right at all, rather than that none is.
  double at_all = 0.0;

  LogOdds& operator+=(const LogOdds& other);
};

/// How much a scan counts: 1 beside nothing else, less where others saw nearly the same.
struct ScanWeight {
  double among = 1.0, at_all = 1.0;
};

/// What one scan says for a pose, where the second-best mode of the map has the even support
/// `rival`: a map in which wrong poses fit nearly as well proves little.
LogOdds log_odds_of(const PoseSupport& support, double rival, const ScanWeight& weight);

/// Probability of each hypothesis that it is the right one; what is missing to 1 is for none of
/// them. Coefficients were fitted by tests/bench/fits/fit_confidence.py.
std::vector<double> probabilities(std::span<const LogOdds> hypotheses);

}  // namespace voxlist::matching
