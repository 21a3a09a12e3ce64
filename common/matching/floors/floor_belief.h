#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/matching/floors/floor_view.h"

namespace voxlist::matching {

/// Whether a robot that is followed on one of a map's floors is on another one by now: a lift
/// carries it to where walls are the same. Lifts are rare, and a robot that sees its surroundings
/// all the time is in none; one that stood where it saw nothing else may well have been.
class FloorBelief {
 public:
  /// A floor that the robot may be on, as the last scan lies on it, and the logarithm of the odds
  /// that it is, rather than on the one where it is followed.
  struct Rival {
    FloorView view;
    double log_odds = 0.0;
  };

  /// Takes a scan as it lies where the robot is followed, and on the other floors there.
  /// `is_boxed`: it shows no more than a box about the robot, which rides with it.
  void weigh(std::int64_t utime_us, bool is_boxed, const FloorView& here,
             const std::vector<FloorView>& others);

  const std::vector<Rival>& rivals() const { return rivals_; }

  /// That the robot is where it is followed, and that it is on each of the rivals.
  std::vector<double> probabilities() const;

  /// The robot is followed elsewhere now.
  void clear() { *this = {}; }

 private:
  struct Seen {
    std::int64_t utime_us;
    Eigen::Vector3d at;
  };
  double odds_of_lift(std::int64_t utime_us, const Eigen::Vector3d& at) const;
  double past(const FloorView& floor) const;

  std::vector<Rival> rivals_;
  // The last scan that showed its surroundings.
  std::optional<Seen> seen_;
  // It was the last scan.
  bool sees_ = false;
};

}  // namespace voxlist::matching
