#include "voxlist/voxels/counters/counter_rule.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/elementary.h"

namespace voxlist {
namespace {

constexpr double kLowest = -2.0, kHighest = 3.5;
constexpr int kMostCounts = 15;

double logit(double probability) { return elementary::log(probability / (1.0 - probability)); }

// One pass in so many counts.
CounterRule rule_of(double hit, double pass, int counts) {
  CounterRule rule;
  rule.pass = counts;
  rule.log_odds = pass / counts;
  rule.lowest = -static_cast<int>(std::lround(-kLowest / rule.log_odds));
  rule.highest = static_cast<int>(std::floor(kHighest / rule.log_odds));
  rule.hit = std::max(1, static_cast<int>(std::lround(hit / rule.log_odds)));
  return rule;
}

bool fits(const CounterRule& rule) { return rule.highest - rule.lowest < kMostCounts; }

}  // namespace

CounterRule CounterRule::of(double hit_probability, double pass_probability) {
  const double hit = logit(hit_probability), pass = -logit(std::min(pass_probability, 0.4));
  // The finest that fits.
  CounterRule rule = rule_of(hit, pass, 1);
  for (int counts = 2; fits(rule_of(hit, pass, counts)); ++counts)
    rule = rule_of(hit, pass, counts);
  rule.lowest = std::min(rule.lowest, -1);
  rule.highest = std::max(rule.highest, 0);
  rule.hit = std::min(rule.hit, rule.highest - rule.lowest);
  rule.pass = std::min(rule.pass, rule.highest - rule.lowest);
  return rule;
}

double CounterRule::log_odds_of(int count) const {
  return std::clamp(count * log_odds, kLowest, kHighest);
}

}  // namespace voxlist
