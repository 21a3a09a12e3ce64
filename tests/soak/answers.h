#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "voxlist/geometry/pose.h"

namespace voxlist::soak {

/// What became of the clouds of some time.
struct Answers {
  int tracking = 0, ambiguous = 0, lost = 0;
  int wrong = 0;                  ///< TRACKING, and not where the robot is
  int unanswered = 0;             ///< clouds without a LOCALISATION
  std::vector<double> answer_ms;  ///< from CLOUD to LOCALISATION, as a listener hears them
  std::vector<double> error_mm;   ///< of each TRACKING, from the truth

  void add(const Answers& more);
  int clouds() const { return tracking + ambiguous + lost + unanswered; }
};

/// A pose farther from the truth than this is wrong (m, rad), as in tests/bench.
inline constexpr double kWrong_m = 0.3, kWrong_rad = 0.0873;

/// The true poses of the last seconds.
class RecentTruth {
 public:
  void add(std::int64_t utime_us, const Pose2& T_map_base);

  /// The pose then, interpolated; precondition: add() was called. Held before the first and after
  /// the last that is kept.
  Pose2 at(std::int64_t utime_us) const;

 private:
  std::map<std::int64_t, Pose2> poses_;
};

/// The value that `percent` of them do not exceed (nearest rank); 0 of none.
double percentile(std::vector<double> values, double percent);

}  // namespace voxlist::soak
