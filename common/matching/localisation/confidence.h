#pragma once

#include <span>
#include <vector>

namespace voxlist::matching {

/// What scans say for and against a place, as sums of logarithms of odds.
struct Odds {
  /// Against other places: a difference of two places' sums is the logarithm of their odds.
  double place = 0.0;
  /// That the place is right at all, rather than that no known place is.
  double found = 0.0;

  Odds& operator+=(const Odds& other);
};

/// How well a scan and the map agree at a place, at most 1 each.
struct PlaceSupport {
  /// By rays close together: what is near counts most, and so do small things in it. Tells places
  /// apart that are alike.
  double near = 0.0;
  /// By rays spread evenly over all surfaces in sight: tells whether it can be the place at all.
  double even = 0.0;
};

/// How much a scan counts: 1 beside nothing else, less where others saw nearly the same.
struct ScanWeight {
  double place = 1.0, found = 1.0;
};

/// What one scan says for a place, where the best other place of the map has the even support
/// `rival`: a map in which wrong places fit nearly as well proves little.
Odds odds_of(const PlaceSupport& support, double rival, const ScanWeight& weight);

/// Probability of each place that it is the right one; what is missing to 1 is for none of them.
/// Coefficients were fitted by tests/bench/fit_confidence.py.
std::vector<double> probabilities(std::span<const Odds> places);

}  // namespace voxlist::matching
