#include "voxlist/matching/localisation/confidence.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/elementary.h"

namespace voxlist::matching {
namespace {

// Fitted by tests/bench/fits/fit_confidence.py on single scans of several kinds of buildings.
// Places are compared by powers of what they leave unexplained: where one explains nearly all, a
// hundredth less counts more than where all leave much.
constexpr double kPlacePower = 27.0, kNearSlack = 0.05;
constexpr double kFoundBias = -11.5, kFoundSupport = 4.6, kFoundRival = 6.9;
constexpr double kEvenSlack = 0.02;

double log_unexplained(double support, double slack) {
  return elementary::log(1.0 - support + slack);
}

}  // namespace

LogOdds& LogOdds::operator+=(const LogOdds& other) {
  among += other.among;
  at_all += other.at_all;
  return *this;
}

LogOdds log_odds_of(const PoseSupport& support, double rival, const ScanWeight& weight) {
  const double here = log_unexplained(support.even, kEvenSlack);
  const double ahead = std::max(0.0, log_unexplained(rival, kEvenSlack) - here);
  return {-weight.among * kPlacePower * log_unexplained(support.near, kNearSlack),
          weight.at_all * (kFoundBias - kFoundSupport * here + kFoundRival * ahead)};
}

std::vector<double> probabilities(std::span<const LogOdds> hypotheses) {
  if (hypotheses.empty()) return {};
  const auto best =
      std::max_element(hypotheses.begin(), hypotheses.end(),
                       [](const LogOdds& a, const LogOdds& b) { return a.among < b.among; });
  const double found = 1.0 / (1.0 + elementary::exp(-best->at_all));
  std::vector<double> result;
  double sum = 0.0;
  for (const LogOdds& odds : hypotheses) {
    result.push_back(elementary::exp(odds.among - best->among));
    sum += result.back();
  }
  for (double& p : result) p *= found / sum;
  return result;
}

}  // namespace voxlist::matching
