#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace voxlist::test {

/// A message as a log has it.
struct SceneMessage {
  std::string channel;
  std::int64_t utime_us = 0;
  std::vector<std::uint8_t> bytes;
};

/// What scene() has.
inline constexpr int kSeconds = 20;
inline constexpr std::int64_t kSceneStart_us = 1'700'000'000'000'000;
/// In the last second the robot may be at this many places.
inline constexpr int kPlaces = 3;
inline constexpr int kGridColumns = 6, kGridRows = 4;

/// What the services say of a robot that drives for kSeconds through a room, 0.5 m a second, while
/// its map grows: CLOUD, CLOUD_SLICE, POSE, ODOMETRY, TRUTH, T_MAP_ODOM, LOCALISATION, MAP_UPDATE,
/// FREE_SPACE, OBSTACLES with something that moves, GRID_low, TRAVERSABILITY_low (compressed),
/// SCAN_low, SCAN_FAR_low and HEALTH, once a second each.
std::vector<SceneMessage> scene();

/// Points of the cloud of each second, and where the robot is then.
int points_of_cloud();
double x_m(int second);

}  // namespace voxlist::test
