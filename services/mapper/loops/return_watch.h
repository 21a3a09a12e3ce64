#pragma once

#include <cstddef>
#include <vector>

#include "voxlist/geometry/pose.h"

namespace voxlist::services {

/// Counts the keyframes from which a drive may see ground that it mapped long before.
class ReturnWatch {
 public:
  /// `sight_m`: how far a scan sees.
  explicit ReturnWatch(double sight_m) : sight_m_(sight_m) {}

  void add(const Pose2& T_map_keyframe);

  /// Those since reset().
  std::size_t returns() const { return returns_; }
  void reset() { returns_ = 0; }

  void clear() { *this = ReturnWatch(sight_m_); }

 private:
  bool comes_back(const Pose2& pose, double way_m) const;

  double sight_m_;
  std::vector<Pose2> poses_;
  std::vector<double> ways_m_;
  std::size_t returns_ = 0;
};

}  // namespace voxlist::services
