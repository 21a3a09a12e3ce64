#pragma once

#include <optional>

#include "voxlist/geometry/tilt.h"
#include "voxlist/matching/localisation/localisation.h"

namespace voxlist {
class localisation_t;
}  // namespace voxlist

namespace voxlist::services {

/// A pose as LOCALISATION tells it: its planar part as it is, for thresholds of the way, and the
/// rest.
struct ToldPose {
  Pose2 planar;
  Tilt tilt;
};

/// The pose of a cloud that is TRACKING; none when it is not, or when the pose is not finite or out
/// of a map's reach.
std::optional<ToldPose> pose_of(const localisation_t& message);

/// What the localiser found, as far as LOCALISATION carries it.
matching::Localisation told(const localisation_t& message);

}  // namespace voxlist::services
