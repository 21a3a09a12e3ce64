#include "voxlist/matching/floors/levelling.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"
#include "voxlist/matching/floors/standing_heights.h"

namespace voxlist::matching {
namespace {

// A map's floor is looked for within this distance (m), as a cloud seen from above. Of its voxels
// one of 4 x 4 is enough.
constexpr double kNear_m = 10.0;
constexpr float kSeenFrom_m = 2.0F;
constexpr std::uint64_t kOneOf16 = 0x00000011'00000011;

// A search finds what is lifted by less than this (m).
constexpr double kSameHeight_m = 0.1;

// A robot is lifted from cloud to cloud by no more than this (m) and this share of its way beyond
// what its lean says: bumps, springs, and what a map's heights are off by. A judgement.
constexpr double kHeave_m = 0.1, kHeaveShare = 0.2;
// A floor that leans otherwise than the robot did (rad), or is not told, may be where a slope
// begins or ends: the robot's pitch then changes by about so much from cloud to cloud.
constexpr double kFlat_rad = 2.0 * kRadPerDeg, kSlope_rad = 4.0 * kRadPerDeg;

// The floor under a robot is looked for this far (m) below its base and above it: other floors are
// farther away.
constexpr double kBelow_m = 1.5, kAbove_m = 1.0;

VoxelBlock one_of_16(VoxelBlock block) {
  for (std::uint64_t& word : block) word &= kOneOf16;
  return block;
}

// What is about a place of the map at a height, in that place's frame.
Cloud cloud_about(const VoxelMap& map, const Pose2& place, double height_m) {
  const Pose3 T_place_map = to_pose3(place, {height_m, 0.0, 0.0}).inverse();
  Cloud cloud;
  const auto add = [&](const Voxel& voxel) {
    const Eigen::Vector3d p = T_place_map * center(voxel, map.resolution_m());
    if (p.z() < -kBelow_m || p.z() > kAbove_m || p.head<2>().norm() >= kNear_m) return;
    cloud.points.push_back(p.cast<float>());
  };
  // Most of a map's blocks are farther away.
  const double edge_m = kBlockEdge * map.resolution_m();
  for (std::size_t i = 0; i < map.block_count(); ++i) {
    const Voxel& block = map.block_position(i);
    const Eigen::Vector2d off(block.x * edge_m - place.x_m, block.y * edge_m - place.y_m);
    if (off.norm() < kNear_m + 2.0 * edge_m)
      VoxelMap::visit_block(block, one_of_16(map.block(i)), add);
  }
  cloud.origins.assign(cloud.points.size(), {0.0F, 0.0F, kSeenFrom_m});
  return cloud;
}

}  // namespace

Tilt Levelling::of_origin(const KnownTilt& known) {
  if (known.odometry) return {0.0, known.odometry->roll_rad, known.odometry->pitch_rad};
  if (known.floor) return {0.0, known.floor->level.roll_rad, known.floor->level.pitch_rad};
  return {};
}

std::vector<Tilt> Levelling::guesses(const KnownTilt& known, const Pose2& place) const {
  std::vector<Tilt> guesses;
  const double expected_m = height_m(place, last());
  if (known.odometry) return {{expected_m, known.odometry->roll_rad, known.odometry->pitch_rad}};
  if (last_) guesses.push_back({expected_m, last().roll_rad, last().pitch_rad});
  if (known.floor) {
    Tilt by_floor = known.floor->level;
    by_floor.z_m = floor_m_ ? *floor_m_ + by_floor.z_m : expected_m;
    if (!reaches(place, by_floor)) by_floor.z_m = expected_m;
    guesses.push_back(by_floor);
  }
  if (guesses.empty()) guesses.emplace_back();
  const bool is_flat =
      known.floor && std::abs(guesses.back().pitch_rad - last().pitch_rad) < kFlat_rad;
  if (last_ && !is_flat)
    for (const double change : {-kSlope_rad, kSlope_rad})
      guesses.push_back({expected_m, last().roll_rad, last().pitch_rad + change});
  return guesses;
}

// The height at a place of a robot that is tilted like this there.
double Levelling::height_m(const Pose2& place, const Tilt& tilt) const {
  if (!last_) return 0.0;
  const Pose2 way = last_->place.inverse() * place;
  const double pitch = 0.5 * (tilt.pitch_rad + last_->tilt.pitch_rad),
               roll = 0.5 * (tilt.roll_rad + last_->tilt.roll_rad);
  return last_->tilt.z_m - elementary::sin(pitch) * way.x_m + elementary::sin(roll) * way.y_m;
}

bool Levelling::reaches(const Pose2& place, const Tilt& tilt) const {
  if (!last_) return true;
  const double way_m = distance_m(place, last_->place);
  return std::abs(tilt.z_m - height_m(place, tilt)) <= kHeave_m + kHeaveShare * way_m;
}

void Levelling::change_map(const Pose2& T_new_old) {
  if (last_) last_->place = T_new_old * last_->place;
}

std::vector<Tilt> Levelling::guesses_anywhere(const KnownTilt& known) const {
  const Tilt level = of_origin(known);
  // How high base is above the floor: as the cloud shows it, or as it was.
  const double above_m = known.floor ? known.floor->level.z_m : -floor_m_.value_or(0.0);
  std::vector<Tilt> guesses;
  for (const double floor_m : floors_m_)
    guesses.push_back({floor_m + above_m, level.roll_rad, level.pitch_rad});
  const bool lists_origin = std::any_of(guesses.begin(), guesses.end(), [](const Tilt& guess) {
    return std::abs(guess.z_m) < kSameHeight_m;
  });
  if (!lists_origin) guesses.push_back(level);
  return guesses;
}

void Levelling::learn(const Pose2& place, const Tilt& tilt, const std::optional<Floor>& floor) {
  last_ = {place, tilt};
  if (floor) floor_m_ = tilt.z_m - floor->level.z_m;
}

void Levelling::look_at(const OccupancyMap& map) {
  if (looked_at_ == map.revision()) return;
  const bool is_first = !looked_at_;
  looked_at_ = map.revision();
  floors_m_ = standing_heights(map);
  if (floor_m_ || !is_first) return;
  if (const auto floor = find_floor(cloud_about(map.occupied, {}, 0.0)))
    floor_m_ = floor->height_m();
}

std::optional<Tilt> floor_on_floor(const OccupancyMap& map, const Pose2& place, double height_m,
                                   const Floor& floor) {
  const auto below = find_floor(cloud_about(map.occupied, place, height_m));
  if (!below) return std::nullopt;
  Tilt tilt = tilt_of(to_level(below->level).inverse() * to_level(floor.level));
  tilt.z_m += height_m;
  return tilt;
}

}  // namespace voxlist::matching
