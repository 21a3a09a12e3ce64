#include "matching/confidence.h"

#include <algorithm>
#include <cmath>

namespace voxlist {
namespace {

// Fitted by tests/bench/fit_confidence.py on single scans of five kinds of buildings.
// Places are compared by (what is left unexplained + kSlack) ^ -kPlacePower: where one place
// explains nearly all, a hundredth less counts more than where all leave much to explain.
constexpr double kPlacePower = 18.0, kSlack = 0.02;
constexpr double kFoundBias = -24.4, kFoundSupport = 26.9, kFoundMargin = 35.2;
// A rival that is farther behind than this says no more than none.
constexpr double kFarBehind = 0.08;

}  // namespace

Odds& Odds::operator+=(const Odds& other) {
  place += other.place;
  found += other.found;
  return *this;
}

Odds odds_of(double support, double rival, const ScanWeight& weight) {
  const double margin = std::min(support - rival, kFarBehind);
  return {-weight.place * kPlacePower * std::log(1.0 - support + kSlack),
          weight.found * (kFoundBias + kFoundSupport * support + kFoundMargin * margin)};
}

std::vector<double> probabilities(std::span<const Odds> places) {
  if (places.empty()) return {};
  const auto best = std::max_element(
      places.begin(), places.end(), [](const Odds& a, const Odds& b) { return a.place < b.place; });
  const double found = 1.0 / (1.0 + std::exp(-best->found));
  std::vector<double> result;
  double sum = 0.0;
  for (const Odds& odds : places) {
    result.push_back(std::exp(odds.place - best->place));
    sum += result.back();
  }
  for (double& p : result) p *= found / sum;
  return result;
}

}  // namespace voxlist
