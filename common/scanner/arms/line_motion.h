#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "voxlist/geometry/laser_line.h"

namespace voxlist::scanner {

/// Tells from the laser's lines alone whether they are turned by a mirror: a line is compared with
/// one from some 20 deg of the beam's turn before. A turning mirror changes what most beams meet,
/// the robot's own motion does not in so short a time.
class LineMotion {
 public:
  /// Takes the next line and compares it with the one that was `lag_us` earlier: the share of the
  /// beams that met something else, 0 to 1. Nothing with too few returns, or no such line.
  std::optional<double> add(const LaserLine& line, double lag_us);

  void reset() { lines_.clear(); }

 private:
  std::deque<LaserLine> lines_;
};

/// Notices that the mirror stands, from how long lines have been still: longer than they ever were
/// between the last passages of the arms (blind wedges, flat ground, a wall straight ahead). The
/// fewer beams changed, the more a line's time counts: where a turning mirror changes little, it
/// does not change nothing. Knows nothing before the first few passages. Only lines that came
/// count: time without them is no stillness, and after a tenth of a second without them the watch
/// begins anew.
class StallWatch {
 public:
  /// `changed`: the share of a line's beams, as LineMotion tells it.
  void add(std::optional<double> changed, std::int64_t utime_us);

  /// An arm passed where it was expected: the mirror turned until now.
  void turned();

  /// Lines are still for longer than a turning mirror leaves them.
  bool stalled() const;

  /// The time for which lines have been still (us), each line weighted by how still it is.
  double still_us() const { return still_us_; }

  /// Lines changed not long ago: no longer than a turning mirror leaves them as they are.
  bool moving() const;

  /// Several lines in a row have changed: what stood is turning again.
  bool turning() const { return moving_lines_ >= kTurningLines; }

  void reset() { *this = {}; }

 private:
  // The longest that something took between each of the last passages.
  struct Longest {
    void passed(double now_us);
    double normal_us() const;

    double since_passage_us = 0.0;
    std::deque<double> earlier_us;
  };

  static constexpr double kRestless_us = 300'000.0;
  static constexpr int kTurningLines = 5;

  bool knows_normal() const;

  double still_us_ = 0.0;  // of the time since lines moved
  double since_moving_us_ = kRestless_us;
  int moving_lines_ = 0;  // in a row
  bool hole_since_passage_ = false;
  Longest longest_still_, longest_unmoved_;
  std::optional<std::int64_t> last_us_;
};

}  // namespace voxlist::scanner
