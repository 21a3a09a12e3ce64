#include "services/mapper/told.h"

#include <cmath>
#include <voxlist/localisation_t.hpp>

#include "voxlist/bus/maps/map_faults.h"
#include "voxlist/geometry/elementary.h"

namespace voxlist::services {
namespace {

// Farthest from the origin that a robot maps (m): what it sees from there is within the map's
// reach.
constexpr double kDrive_m = bus::kMapReach_m - 1000.0;

}  // namespace

std::optional<ToldPose> pose_of(const localisation_t& message) {
  if (message.state != localisation_t::STATE_TRACKING || message.modes.empty()) return std::nullopt;
  const double* pose = message.modes.front().pose;
  const double* tilt = message.modes.front().tilt;
  const bool sane = elementary::hypot(elementary::hypot(pose[0], pose[1]), tilt[0]) < kDrive_m &&
                    std::isfinite(pose[2]) && std::isfinite(tilt[1]) && std::isfinite(tilt[2]);
  if (!sane) return std::nullopt;
  return ToldPose{{pose[0], pose[1], wrap_angle(pose[2])},
                  {tilt[0], wrap_angle(tilt[1]), wrap_angle(tilt[2])}};
}

matching::Localisation told(const localisation_t& message) {
  matching::Localisation found;
  found.utime_us = message.utime;
  found.state = static_cast<matching::LocalisationState>(message.state);
  found.confidence = message.modes.empty() ? 0.0 : message.confidence;
  found.searched_whole_map = message.searched_whole_map;
  for (const pose_mode_t& told : message.modes) {
    matching::PoseMode& mode = found.modes.emplace_back();
    mode.T_map_base = {told.pose[0], told.pose[1], wrap_angle(told.pose[2])};
    for (int i = 0; i < 9; ++i) mode.covariance(i / 3, i % 3) = told.covariance[i];
  }
  return found;
}

}  // namespace voxlist::services
