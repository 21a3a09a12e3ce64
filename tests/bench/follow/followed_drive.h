#pragma once

#include <cstdint>
#include <limits>

namespace voxlist::bench {

/// What a follower sees with.
enum class FollowersLaser {
  kMirror,  ///< the mirror scanner: slices at 15 Hz, once round in a second
  kRings,   ///< 16 rings of 360 points, all round at 10 Hz
};

/// A drive of the follower of tests/clients through a simulated building, from one place to
/// another, at up to 1 m/s.
struct FollowedDriveConfig {
  int seed = 1;
  FollowersLaser laser = FollowersLaser::kRings;
  /// Every so often somebody steps onto its way, 2 m before it, stands there and goes on (m of its
  /// way); 0: nobody does.
  double step_in_every_m = 4.0;
  /// It gives up after so long.
  double longest_s = 60.0;
  /// From then on no OBSTACLES come, or such that say that nothing is seen (s).
  double silent_from_s = std::numeric_limits<double>::infinity();
  double blind_from_s = std::numeric_limits<double>::infinity();
};

struct FollowedDriveResult {
  bool arrived = false;
  int stepped_in = 0;                                          ///< people
  bool touched = false;                                        ///< something, while it moved
  double nearest_m = std::numeric_limits<double>::infinity();  ///< from its hull, while it moved
  double seconds = 0.0;
  double way_m = 0.0;          ///< that it drove
  double stood_after_s = 0.0;  ///< how long it moved on without OBSTACLES or sight
  int looks = 0;               ///< OBSTACLES
  int looks_with_drop = 0;     ///< those with a NEGATIVE, of which the building has none
};

/// Drives until it has arrived, or gives up. Equal configs give equal results.
FollowedDriveResult follow(const FollowedDriveConfig& config);

}  // namespace voxlist::bench
