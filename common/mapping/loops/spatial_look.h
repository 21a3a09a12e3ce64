#pragma once

#include <optional>
#include <vector>

#include "voxlist/geometry/uncertain_pose.h"
#include "voxlist/mapping/graph/spatial_edge.h"
#include "voxlist/mapping/loops/local_map.h"

namespace voxlist::mapping {

/// A look at how a keyframe stands in space to others, by its surfaces on theirs: all are made
/// level by what is known of their tilt, so what is found is what that is off by.
struct SpatialLook {
  /// A keyframe that it is held against, where it stands in the level frame of the first one.
  struct Other {
    std::size_t keyframe = 0;
    Pose2 T_from_other;
    Tilt tilt;

    bool operator==(const Other&) const = default;
  };

  std::size_t keyframe = 0;
  Tilt tilt;
  /// T_from_keyframe, where it is looked for.
  Pose2 expected;
  /// How far above and below that (m) it may stand.
  double off_m = 0.0;
  std::vector<Other> others;  ///< at least one

  bool operator==(const SpatialLook&) const = default;
};

/// T_from_keyframe between their level frames; nothing where its surfaces do not lie on theirs.
/// `read`: level clouds. 10 to 30 ms, and 3 ms for each decimetre that it may be off.
std::optional<UncertainPose3> look_in_space(const SpatialLook& look, const ReadCloud& read,
                                            const matching::MatcherConfig& config);

}  // namespace voxlist::mapping
