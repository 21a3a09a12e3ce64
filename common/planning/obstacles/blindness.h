#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/mirror_state.h"

namespace voxlist::planning {

/// Whether nothing can be told of what is round the robot, and why: no clouds, a mirror whose angle
/// is not known, a covered lens. Times of clouds are the data's; `now_us` is any clock that never
/// goes back.
class Blindness {
 public:
  /// `min_range_m`: points nearer to where their rays started are what covers the lens.
  explicit Blindness(double min_range_m) : min_range_m_(min_range_m) {}

  void take(const Cloud& cloud_base, std::int64_t now_us);

  /// MIRROR is asked and not HEALTH: it comes with each line, HEALTH once a second.
  void take(const MirrorState& state, std::int64_t now_us);

  /// One line for a person; empty: it sees.
  std::string why(std::int64_t now_us) const;

 private:
  struct Seen {
    std::int64_t utime_us;
    std::size_t points;
  };

  std::int64_t silence_us() const;
  void count_points(const Cloud& cloud_base);
  std::optional<std::size_t> recent_points() const;

  double min_range_m_;
  std::optional<std::int64_t> cloud_us_, mirror_us_;  // when the last came
  std::int64_t period_us_ = 0;                        // of clouds; 0: not known
  MirrorState mirror_;
  std::deque<Seen> seen_;
  std::size_t most_points_ = 0;
};

}  // namespace voxlist::planning
