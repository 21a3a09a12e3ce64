#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/tilt.h"

namespace voxlist::services {

/// Where the robot was, in bounded memory: each of its newest poses, and of those before only the
/// keyframes'.
class TravelledPath {
 public:
  /// Newest poses that are all kept: 17 minutes at 10 Hz, 0.6 MB.
  static constexpr std::size_t kNewest = 10'000;

  /// A keyframe of before, or one that got its place later than those after it.
  void restore(const StampedPose3& keyframe) { old_keyframes_.push_back(keyframe); }

  void add(const StampedPose2& pose, const Tilt& tilt = {});

  /// The pose added last has become a keyframe's.
  void mark_keyframe() { newest_.back().is_keyframe = true; }

  /// Keyframes were moved, `before` to `after`: all that is known goes with them.
  void move(std::span<const StampedPose3> before, std::span<const StampedPose3> after);

  /// All that is known, oldest first.
  std::vector<StampedPose3> poses() const;

 private:
  struct Entry {
    StampedPose2 pose;
    Tilt tilt;
    bool is_keyframe = false;

    StampedPose3 in_3d() const;
  };

  std::vector<StampedPose3> old_keyframes_;
  std::deque<Entry> newest_;
};

}  // namespace voxlist::services
