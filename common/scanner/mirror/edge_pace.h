#pragma once

#include <deque>
#include <optional>

namespace voxlist::scanner {

/// Watches whether a clock's edges still come with its period: a motor that is given another speed
/// is noticed within some 30 edges, at large changes within about half as many. Jitter, lost,
/// doubled and a few strange edges are no other speed. Twice the period, or three times, is not
/// told from lost edges.
class EdgePace {
 public:
  /// Takes the next edge of a clock whose period is well known, microseconds since any fixed time.
  /// True when by now the edges have another period, longer or shorter by 5 % or more;
  /// 3 % at the least.
  bool changed(double since_us, double period_us);

  void reset() { *this = {}; }

 private:
  std::optional<double> last_us_, last_good_us_;
  std::deque<double> late_;  // each edge against one before it, in periods
};

}  // namespace voxlist::scanner
