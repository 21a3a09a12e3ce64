#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "voxlist/bus/channels.h"

namespace voxlist::desk {

/// What the bus tells of the robot: where it is and how sure, its map, the nearest obstacle. Times
/// are seconds of any clock that never goes back.
class RobotView {
 public:
  RobotView();
  ~RobotView();

  void take(const localisation_t& message, double now_s);
  void take(const keyframe_t& message, double now_s);
  void take(const obstacles_t& message, double now_s);

  /// Whether a LOCALISATION was heard, and when last.
  bool seen() const { return localisations_ > 0; }
  double last_seen_s() const { return last_seen_s_; }

  /// What is known, and how old it is when it is more than a moment old. While it is AMBIGUOUS one
  /// line more for each candidate with its probability.
  std::vector<std::string> lines(double now_s) const;

  /// One line about all that was heard.
  std::string summary() const;

 private:
  std::string pose_line(double now_s) const;
  std::string surroundings(double now_s) const;

  std::unique_ptr<localisation_t> last_;
  double last_seen_s_ = 0.0;
  std::int64_t first_utime_us_ = 0;
  int localisations_ = 0, tracking_ = 0, keyframes_ = 0;
  std::optional<double> nearest_seen_s_;
  float nearest_m_ = std::numeric_limits<float>::infinity();
};

}  // namespace voxlist::desk
