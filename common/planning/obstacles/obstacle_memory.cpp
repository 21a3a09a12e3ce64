#include "voxlist/planning/obstacles/obstacle_memory.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "voxlist/planning/rays/passed_through.h"

namespace voxlist::planning {
namespace {

// Floor nearer than this (m) is remembered: what the robot hides, and what makes the edge of a drop
// sharper than single sweeps do.
constexpr float kFloorWithin_m = 2.0F;

// Rays are held against what stood at heights so far apart (m): as far as they refute a point.
constexpr float kHeights_m = 0.12F;

constexpr int kDrop = static_cast<int>(ObstacleType::kNegative);

// Whether the floor goes on where there was a drop: in its cell and all round it, for at its edge
// there is floor on one side at least, and none of it lower down.
bool is_closed(std::size_t cell, const LocalGrid& grid, const LocalFloor& ground,
               const FloorRule& rule) {
  bool closed = ground.is_floor[cell] != 0;
  float low_m = ground.height_m[cell], high_m = low_m;
  grid.around(cell, grid.disc(1.5 * static_cast<double>(grid.cell_m())),
              [&](std::size_t other, float) {
                closed = closed && ground.is_floor[other] != 0;
                low_m = std::min(low_m, ground.height_m[other]);
                high_m = std::max(high_m, ground.height_m[other]);
              });
  return closed && high_m - low_m <= rule.most_m(2.0F * grid.cell_m(), grid.range_m(cell));
}

}  // namespace

void ObstacleMemory::forget_before(std::int64_t oldest_us) {
  std::erase_if(entries_, [&](const auto& entry) { return entry.second.utime_us < oldest_us; });
}

void ObstacleMemory::forget_tilted(std::int64_t since_us) {
  std::erase_if(entries_, [&](const auto& entry) {
    return std::get<2>(entry.first) == kFloor || entry.second.utime_us >= since_us;
  });
}

std::vector<Eigen::Vector3f> ObstacleMemory::look_again(const Pose3& T_odom_base,
                                                        const std::vector<Ray>& news) {
  const Eigen::Isometry3f T_base_odom = T_odom_base.inverse().cast<float>();
  std::vector<Ray> standing;
  std::vector<std::map<Key, Entry>::iterator> of;
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    const int type = std::get<2>(entry->first);
    if (type == kFloor || type == kDrop) continue;
    // What is in sight and was not met again is gone, however thin it is.
    Eigen::Vector3f point = entry->second.point;
    for (point.z() = entry->second.low_m; point.z() <= entry->second.high_m;
         point.z() += kHeights_m) {
      standing.push_back({T_base_odom * point, Eigen::Vector3f::Zero(), 0, true, false, 0});
      of.push_back(entry);
    }
  }
  count_passes(standing, news);
  for (std::size_t i = 0; i < of.size(); ++i) of[i]->second.passed += standing[i].passed;
  std::vector<Eigen::Vector3f> gone;
  std::erase_if(entries_, [&](const auto& entry) {
    const bool is_gone = is_refuted({{}, {}, 0, true, false, entry.second.passed});
    if (is_gone) gone.push_back(T_base_odom * entry.second.point);
    return is_gone;
  });
  return gone;
}

std::vector<float> ObstacleMemory::floor_heights(const Pose3& T_odom_base,
                                                 const LocalGrid& grid) const {
  const Eigen::Isometry3f T_base_odom = T_odom_base.inverse().cast<float>();
  std::vector<float> heights_m(grid.size(), std::numeric_limits<float>::quiet_NaN());
  for (const auto& [key, entry] : entries_) {
    if (std::get<2>(key) != kFloor) continue;
    const Eigen::Vector3f point = T_base_odom * entry.point;
    if (const auto cell = grid.at(point.head<2>())) heights_m[*cell] = point.z();
  }
  return heights_m;
}

void ObstacleMemory::recall(const Pose3& T_odom_base, const LocalGrid& grid,
                            const LocalFloor& ground, const FloorRule& rule,
                            std::vector<TypedPoint>& points) {
  const Eigen::Isometry3f T_base_odom = T_odom_base.inverse().cast<float>();
  for (auto next = entries_.begin(); next != entries_.end();) {
    const auto entry = next++;
    const int type = std::get<2>(entry->first);
    if (type == kFloor) continue;
    const Eigen::Vector3f point = T_base_odom * entry->second.point;
    const auto cell = grid.at(point.head<2>());
    if (!cell) continue;
    if (type == kDrop && is_closed(*cell, grid, ground, rule))
      entries_.erase(entry);
    else
      points.push_back({point, static_cast<ObstacleType>(type), *cell, entry->second.utime_us});
  }
}

void ObstacleMemory::learn(const Pose3& T_odom_base, std::int64_t utime_us, const LocalGrid& grid,
                           const std::vector<Ray>& rays, const LocalFloor& ground,
                           const std::vector<TypedPoint>& points) {
  const Eigen::Isometry3f T = T_odom_base.cast<float>();
  for (const Ray& ray : rays) {
    const auto cell = grid.at(ray.point.head<2>());
    const bool is_floor = cell && ground.is_floor[*cell] && grid.range_m(*cell) < kFloorWithin_m &&
                          ray.point.z() <= ground.height_m[*cell];
    if (is_floor) note(T * ray.point, kFloor, grid.cell_m(), utime_us);
  }
  for (const TypedPoint& point : points)
    note(T * point.point, static_cast<int>(point.type), grid.cell_m(), utime_us);
}

void ObstacleMemory::note(const Eigen::Vector3f& point_odom, int type, float cell_m,
                          std::int64_t utime_us) {
  const Key key{static_cast<int>(std::floor(point_odom.x() / cell_m)),
                static_cast<int>(std::floor(point_odom.y() / cell_m)), type};
  const float z_m = point_odom.z();
  const auto [entry, is_new] = entries_.try_emplace(key, Entry{point_odom, utime_us, z_m, z_m});
  if (is_new) return;
  Entry& known = entry->second;
  known = {point_odom, utime_us, std::min(known.low_m, z_m), std::max(known.high_m, z_m)};
}

}  // namespace voxlist::planning
