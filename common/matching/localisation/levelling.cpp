#include "voxlist/matching/localisation/levelling.h"

#include <cmath>

namespace voxlist::matching {
namespace {

// A map's floor is looked for within this distance (m), as a cloud seen from above. Of its voxels
// one of 4 x 4 is enough.
constexpr double kNear_m = 10.0;
constexpr float kSeenFrom_m = 2.0F;
constexpr std::int32_t kOneOf = 3;

// A search finds what is lifted by less than this (m).
constexpr double kSameHeight_m = 0.1;

// What is about a place of the map, in that place's frame.
Cloud cloud_about(const VoxelMap& map, const Pose2& place) {
  const Pose3 T_place_map = to_pose3(place).inverse();
  Cloud cloud;
  map.for_each_voxel([&](const Voxel& voxel) {
    if ((voxel.x & kOneOf) != 0 || (voxel.y & kOneOf) != 0) return;
    const Eigen::Vector3d p = T_place_map * center(voxel, map.resolution_m());
    if (p.head<2>().norm() < kNear_m) cloud.points.push_back(p.cast<float>());
  });
  cloud.origins.assign(cloud.points.size(), {0.0F, 0.0F, kSeenFrom_m});
  return cloud;
}

}  // namespace

Tilt Levelling::of_origin(const KnownTilt& known) {
  if (known.odometry) return {0.0, known.odometry->roll_rad, known.odometry->pitch_rad};
  if (known.floor) return {0.0, known.floor->level.roll_rad, known.floor->level.pitch_rad};
  return {};
}

std::vector<Tilt> Levelling::guesses(const KnownTilt& known) const {
  std::vector<Tilt> guesses;
  const double last_m = last_.value_or(Tilt{}).z_m;
  if (known.odometry) return {{last_m, known.odometry->roll_rad, known.odometry->pitch_rad}};
  if (last_) guesses.push_back(*last_);
  if (known.floor) {
    Tilt by_floor = known.floor->level;
    by_floor.z_m = floor_m_ ? *floor_m_ + by_floor.z_m : last_m;
    guesses.push_back(by_floor);
  }
  if (guesses.empty()) guesses.emplace_back();
  return guesses;
}

std::vector<Tilt> Levelling::guesses_anywhere(const KnownTilt& known) const {
  std::vector<Tilt> guesses{of_origin(known)};
  const double z_m = known.floor && floor_m_ ? *floor_m_ + known.floor->level.z_m : 0.0;
  if (std::abs(z_m) < kSameHeight_m) return guesses;
  guesses.push_back(guesses.front());
  guesses.back().z_m = z_m;
  return guesses;
}

void Levelling::learn(const Tilt& tilt, const std::optional<Floor>& floor) {
  last_ = tilt;
  if (floor) floor_m_ = tilt.z_m - floor->level.z_m;
}

void Levelling::look_at(const OccupancyMap& map) {
  if (floor_m_ || looked_at_map_) return;
  looked_at_map_ = true;
  if (const auto floor = find_floor(cloud_about(map.occupied, {}))) floor_m_ = floor->height_m();
}

std::optional<Tilt> floor_on_floor(const OccupancyMap& map, const Pose2& place,
                                   const Floor& floor) {
  const auto below = find_floor(cloud_about(map.occupied, place));
  if (!below) return std::nullopt;
  return tilt_of(to_level(below->level).inverse() * to_level(floor.level));
}

}  // namespace voxlist::matching
