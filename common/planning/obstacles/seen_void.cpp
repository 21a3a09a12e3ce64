#include "voxlist/planning/obstacles/seen_void.h"

#include <cmath>

namespace voxlist::planning {
namespace {

constexpr float kCube_m = 0.1F;

// Cubes are kept where (x, y, z) falls in a block of so many: twice as far as is looked.
constexpr int kSide = 128, kHigh = 32;

// Rays are followed so far from the robot (m), and end so far before what they met (m): noise, and
// rays that graze it.
constexpr float kFar_m = 4.0F, kBefore_m = 0.25F;

// Longer ago nothing is known (us): ODOMETRY is 1 % off, which is a cube in 10 m.
constexpr std::int64_t kKept_us = 10'000'000;

// Rays that ended in a cube within this (us) belong to one look: a sweep's part.
constexpr std::int64_t kLook_us = 600'000;

// After so many rays what was met in a cube is gone.
constexpr std::int32_t kGone = 3;

// More rays than these of one cloud tell nothing more.
constexpr std::size_t kMostRays = 3000;

Eigen::Vector3i cube_of(const Eigen::Vector3f& p) {
  return {static_cast<int>(std::floor(p.x() / kCube_m)),
          static_cast<int>(std::floor(p.y() / kCube_m)),
          static_cast<int>(std::floor(p.z() / kCube_m))};
}

std::size_t index_of(const Eigen::Vector3i& cube) {
  const auto x = static_cast<std::size_t>(cube.x() & (kSide - 1)),
             y = static_cast<std::size_t>(cube.y() & (kSide - 1)),
             z = static_cast<std::size_t>(cube.z() & (kHigh - 1));
  return (x * kSide + y) * kHigh + z;
}

}  // namespace

SeenVoid::SeenVoid() : cubes_(std::size_t{kSide} * kSide * kHigh) {}

void SeenVoid::clear() { cubes_.assign(cubes_.size(), {}); }

const SeenVoid::Cube* SeenVoid::at(const Eigen::Vector3i& cube, std::int64_t utime_us) const {
  const Cube& found = cubes_[index_of(cube)];
  const bool is_it = found.x == cube.x() && found.y == cube.y() && found.z == cube.z() &&
                     found.utime_us > 0 && utime_us - found.utime_us < kKept_us;
  return is_it ? &found : nullptr;
}

SeenVoid::Cube& SeenVoid::open(const Eigen::Vector3i& cube, std::int64_t utime_us) {
  Cube& found = cubes_[index_of(cube)];
  if (!at(cube, utime_us)) found = {cube.x(), cube.y(), cube.z()};
  found.utime_us = utime_us;
  return found;
}

std::vector<bool> SeenVoid::came(const Pose3& T_odom_base, std::int64_t utime_us,
                                 const std::vector<Ray>& news) const {
  const Eigen::Isometry3f T = T_odom_base.cast<float>();
  const auto was_met = [&](const Eigen::Vector3i& cube) {
    const Cube* found = at(cube, utime_us);
    return found && found->first_end_us > 0 && found->first_end_us < utime_us - kLook_us;
  };
  const auto was_void = [&](const Eigen::Vector3i& cube) {
    const Cube* found = at(cube, utime_us);
    return found && found->passes > 0;
  };
  const auto has_come = [&](const Ray& ray) {
    const Eigen::Vector3i cube = cube_of(T * ray.point);
    for (int beside = 0; beside < 27; ++beside) {
      const Eigen::Vector3i step(beside / 9 - 1, beside / 3 % 3 - 1, beside % 3 - 1);
      if (was_met(cube + step) || (step.z() == 0 && !was_void(cube + step))) return false;
    }
    return true;
  };
  std::vector<bool> came(news.size());
  for (std::size_t i = 0; i < news.size(); ++i) came[i] = has_come(news[i]);
  return came;
}

void SeenVoid::learn(const Pose3& T_odom_base, std::int64_t utime_us,
                     const std::vector<Ray>& news) {
  const Eigen::Isometry3f T = T_odom_base.cast<float>();
  const std::size_t step = news.size() / kMostRays + 1;
  for (std::size_t i = 0; i < news.size(); i += step)
    pass(T * news[i].origin, T * news[i].point, T.translation(), utime_us);
  for (const Ray& ray : news) {
    if (ray.point.head<2>().norm() > kFar_m) continue;
    Cube& cube = open(cube_of(T * ray.point), utime_us);
    cube.passes = 0;
    if (cube.first_end_us == 0) cube.first_end_us = utime_us;
  }
}

void SeenVoid::pass(const Eigen::Vector3f& from_odom, const Eigen::Vector3f& to_odom,
                    const Eigen::Vector3f& robot_odom, std::int64_t utime_us) {
  const float length_m = (to_odom - from_odom).norm() - kBefore_m;
  const Eigen::Vector3f way = (to_odom - from_odom).normalized();
  Eigen::Vector3i last = cube_of(from_odom);
  for (float along_m = 0.0F; along_m < length_m; along_m += kCube_m) {
    const Eigen::Vector3f place = from_odom + along_m * way;
    const Eigen::Vector3f away = place - robot_odom;
    if (away.head<2>().norm() > kFar_m || away.z() > 2.0F) return;
    const Eigen::Vector3i here = cube_of(place);
    if (here == last) continue;
    last = here;
    Cube& cube = open(here, utime_us);
    if (++cube.passes >= kGone && cube.first_end_us > 0) cube.passes = 0, cube.first_end_us = 0;
  }
}

}  // namespace voxlist::planning
