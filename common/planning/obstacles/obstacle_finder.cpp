#include "voxlist/planning/obstacles/obstacle_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"
#include "voxlist/planning/obstacles/floor_reach.h"

namespace voxlist::planning {
namespace {

// The robot is trusted to move on at its last velocity for so long (us): ODOMETRY of 20 Hz, with a
// few poses late.
constexpr std::int64_t kExtrapolation_us = 300'000;

// Points of one sighting of a thing that moves are no older (us): less than a sweep takes.
constexpr std::int64_t kSighting_us = 600'000;

// The robot has tilted when a cloud's lowest points on the floor are off by this in their middle
// (rad), and they are so many: three times what it rocks by. Points are on the floor that are near
// it in both ways (m), and no farther from the robot than this (m).
constexpr float kTilted_rad = 0.015F, kAbove_m = 0.3F, kNear_m = 4.0F;
constexpr std::size_t kTiltedCells = 15;

// It takes so long until that is seen (us): until the scanner has
// looked at the floor again, a sweep or two later.
constexpr std::int64_t kTilting_us = 3'000'000;

// The grid's cells: more are seconds of work.
constexpr double kMostCells = 1000.0;

constexpr float kNone = std::numeric_limits<float>::infinity();

std::int64_t in_us(double seconds) {
  return static_cast<std::int64_t>(std::llround(seconds * 1e6));
}

// A detector that can see nothing would tell a planner that the way is free.
const ObstacleConfig& checked(const ObstacleConfig& config) {
  if (config.min_height_m >= config.max_height_m)
    throw std::invalid_argument("min_height_m must be below max_height_m");
  if (config.min_range_m >= config.max_range_m)
    throw std::invalid_argument("min_range_m must be below max_range_m");
  if (config.max_range_m / config.cell_m > kMostCells)
    throw std::invalid_argument("max_range_m must be at most 1000 times cell_m");
  return config;
}

std::size_t sector_of(const Eigen::Vector2f& place, int sectors) {
  const double turns = elementary::atan2(place.y(), place.x()) / kTurn_rad;
  const auto sector = static_cast<int>(std::lround(turns * sectors));
  return static_cast<std::size_t>((sector + sectors) % sectors);
}

}  // namespace

ObstacleFinder::ObstacleFinder(const ObstacleConfig& config)
    : config_(checked(config)), grid_(config.max_range_m, config.cell_m) {}

void ObstacleFinder::add_odometry(const StampedPose2& T_odom_base, const Tilt& tilt) {
  odometry_.add(T_odom_base, tilt);
}

void ObstacleFinder::clear() {
  window_.clear();
  memory_.clear();
  void_.clear();
  tracks_.clear();
  ground_ = {};
}

// Height is the way driven uphill, for the wheels measure none.
Pose3 ObstacleFinder::pose_at(std::int64_t utime_us) {
  const auto planar = odometry_.estimate(utime_us, kExtrapolation_us);
  if (planar.has_value() != has_odometry_) clear();
  has_odometry_ = planar.has_value();
  if (!planar) return Pose3::Identity();
  Tilt tilt = odometry_.tilt_at(utime_us).value_or(Tilt{});
  const double forward_m = (to_pose2(T_odom_base_).inverse() * *planar).x_m;
  tilt.z_m = T_odom_base_.translation().z() - forward_m * elementary::sin(tilt.pitch_rad);
  return to_pose3(*planar, tilt);
}

ObstacleScan ObstacleFinder::take(const Cloud& cloud_base, Part part) {
  if (cloud_base.utime_us < newest_us_) clear();
  newest_us_ = cloud_base.utime_us;
  move_to(pose_at(cloud_base.utime_us), cloud_base);
  const std::vector<Ray> news = window_.add(cloud_base);
  window_.mark_came(void_.came(T_odom_base_, newest_us_, news));
  void_.learn(T_odom_base_, newest_us_, news);
  forget_if_tilted(news);
  window_.forget_gone(memory_.look_again(T_odom_base_, news), grid_.cell_m(), newest_us_);
  spacing_.add(cloud_base);
  return describe(cloud_base.utime_us, part);
}

void ObstacleFinder::move_to(const Pose3& T_odom_base, const Cloud& cloud) {
  const double kept_s = has_odometry_ ? config_.window_s : config_.window_without_odometry_s;
  T_odom_base_ = T_odom_base;
  window_.advance(T_odom_base, cloud.utime_us - in_us(kept_s));
  memory_.forget_before(cloud.utime_us - in_us(config_.memory_s));
  if (cloud.points.empty()) return;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < cloud.points.size(); ++i) sum += cloud.origin(i);
  const auto origin_m = static_cast<double>(sum.z()) / static_cast<double>(cloud.points.size());
  scanner_height_m_ = origin_m - config_.floor_z_m;
}

// Where ODOMETRY does not measure roll and pitch, the floor itself tells that they have changed.
void ObstacleFinder::forget_if_tilted(const std::vector<Ray>& news) {
  if (ground_.is_floor.empty()) return;
  const std::vector<float> low_m = lowest_points(grid_, news, config_);
  std::vector<float> off_rad;
  for (std::size_t cell = 0; cell < low_m.size(); ++cell) {
    if (!ground_.is_floor[cell] || grid_.range_m(cell) > kNear_m) continue;
    const float up_m = low_m[cell] - ground_.height_m[cell];
    if (std::abs(up_m) < kAbove_m) off_rad.push_back(up_m / grid_.range_m(cell));
  }
  if (off_rad.size() < kTiltedCells) return;
  const auto middle = off_rad.begin() + static_cast<std::ptrdiff_t>(off_rad.size() / 2);
  std::ranges::nth_element(off_rad, middle);
  if (std::abs(*middle) < kTilted_rad) return;
  window_.forget_all_but(news);
  memory_.forget_tilted(newest_us_ - kTilting_us);
}

ObstacleScan ObstacleFinder::describe(std::int64_t utime_us, Part part) {
  const std::vector<float> remembered = memory_.floor_heights(T_odom_base_, grid_);
  ground_ = find_ground(grid_, window_.rays(), remembered, config_);
  std::vector<TypedPoint> points = find_standing(grid_, window_.rays(), ground_, config_);
  ObstacleScan scan;
  scan.utime_us = utime_us;
  if (has_odometry_) {
    tracks_.update(T_odom_base_, utime_us, grid_, points, part == Part::kSlice ? kSighting_us : 0);
    scan.moving = tracks_.moving(T_odom_base_, utime_us);
  }
  // The newest slice alone cannot tell a drop from a robot that tilts.
  const std::int64_t until_us = part == Part::kSlice ? utime_us - 1 : utime_us;
  const auto drops = find_drops(grid_, window_.rays(), ground_, config_, until_us);
  points.insert(points.end(), drops.begin(), drops.end());
  const auto steps = find_steps_down(grid_, ground_, config_, utime_us);
  points.insert(points.end(), steps.begin(), steps.end());
  if (has_odometry_) {
    memory_.learn(T_odom_base_, utime_us, grid_, window_.rays(), ground_, points);
    memory_.recall(T_odom_base_, grid_, ground_, FloorRule(config_), points);
  }
  tell_nearest(points, scan);
  return scan;
}

void ObstacleFinder::tell_nearest(const std::vector<TypedPoint>& points, ObstacleScan& scan) const {
  scan.step_rad = kTurn_rad / config_.sectors;
  scan.nearest_m.fill(std::vector<float>(static_cast<std::size_t>(config_.sectors), kNone));
  constexpr auto kFree = static_cast<std::uint8_t>(kObstacleTypes);
  std::vector<std::uint8_t> types(grid_.size(), kFree), blocked(grid_.size()), drops(grid_.size());
  for (const TypedPoint& point : points) {
    const auto type = static_cast<std::size_t>(point.type);
    const float away_m = point.place().norm();
    // Beams meet an edge in every other bearing only: it goes on for a cell.
    const bool is_edge = point.type == ObstacleType::kNegative;
    const double half_rad = is_edge ? 0.5 * config_.cell_m / std::max(away_m, 0.1F) : 0.0;
    const int half = static_cast<int>(half_rad / scan.step_rad);
    for (int beside = -half; beside <= half; ++beside) {
      const auto sector =
          (static_cast<int>(sector_of(point.place(), config_.sectors)) + beside + config_.sectors) %
          config_.sectors;
      float& nearest_m = scan.nearest_m[type][static_cast<std::size_t>(sector)];
      nearest_m = std::min(nearest_m, away_m);
    }
    types[point.cell] = std::min(types[point.cell], static_cast<std::uint8_t>(type));
    if (point.type == ObstacleType::kObstacle) blocked[point.cell] = 1;
    if (is_edge) drops[point.cell] = 1;
  }
  for (std::size_t cell = 0; cell < types.size(); ++cell)
    if (types[cell] != kFree)
      scan.cells.push_back({grid_.centre(cell), static_cast<ObstacleType>(types[cell])});
  const BeamGeometry beams{scanner_height_m_, spacing_.spacing_rad()};
  scan.ground_seen_to_m = floor_reach(grid_, ground_, blocked, drops, beams, config_);
}

}  // namespace voxlist::planning
