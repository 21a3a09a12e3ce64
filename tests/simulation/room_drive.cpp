#include "tests/simulation/room_drive.h"

#include <cmath>
#include <utility>

#include "tests/simulation/sphere_scan.h"
#include "voxlist/simulation/building/building.h"

namespace voxlist::simulation {
namespace {

constexpr double kStep_m = 0.5, kYaw_rad = 0.3;
constexpr SphereScanConfig kLaser{
    .rays = 8640, .rings = 48, .rings_to_deg = 35.0, .range_max_m = 12.0, .range_sd_m = 0.01};

Building building(int seed) {
  BuildingConfig config;
  config.seed = seed;
  return make_building(config);
}

Pose2 at(const Eigen::Vector2d& place) { return {place.x(), place.y(), kYaw_rad}; }

}  // namespace

RoomDrive::RoomDrive(int seed, Take take)
    : world_(building(seed)), take_(std::move(take)), seed_(static_cast<std::uint64_t>(seed)) {}

Pose2 RoomDrive::middle_of(std::size_t room) const {
  return at(world_.building().rooms[room].centre());
}

void RoomDrive::drive(std::size_t from, std::size_t to, bool covered) {
  const Eigen::Vector2d out = world_.building().rooms[from].door,
                        in = world_.building().rooms[to].door;
  for (const Eigen::Vector2d& stop :
       {out, Eigen::Vector2d(out.x(), 0.0), Eigen::Vector2d(in.x(), 0.0), in})
    drive_to(at(stop), covered);
}

void RoomDrive::look_round(std::size_t room) {
  const Pose2 middle = middle_of(room);
  for (const Pose2& stop :
       {middle, middle * Pose2{1.0, 0.5, 0.4}, middle * Pose2{0.0, 1.0, 0.8}, middle})
    drive_to(stop, false);
}

void RoomDrive::drive_to(const Pose2& to, bool covered) {
  const Pose2 from = at_, way = from.inverse() * to;
  const int steps = static_cast<int>(std::ceil(distance_m(from, to) / kStep_m));
  for (int i = 1; i <= steps; ++i) {
    at_ = from * part_of(way, static_cast<double>(i) / steps);
    take_(scan(covered), at_);
  }
}

Cloud RoomDrive::scan(bool covered) {
  if (!covered) return scan_sphere(world_, at_, kLaser, 1000 * seed_ + ++scans_);
  Cloud lid;
  lid.points.emplace_back(0.3F, 0.0F, 0.0F);
  return lid;
}

}  // namespace voxlist::simulation
