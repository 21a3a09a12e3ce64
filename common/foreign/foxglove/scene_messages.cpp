#include "voxlist/foreign/foxglove/scene_messages.h"

#include <fmt/core.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <voxlist/health_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pixel_map_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/rigid_transform_t.hpp>
#include <voxlist/traversability_t.hpp>

#include "voxlist/bus/convert.h"
#include "voxlist/geometry/tilt.h"

namespace voxlist::foreign {
namespace {

using Type = PackedField::Type;

// Most cells of a grid: 800 x 800 m at 0.1 m. A forged size must not take a robot's memory.
constexpr std::int64_t kMostCells = 64'000'000;

// OBSTACLES comes 10 times a second, or with each cloud: what moves is shown this long (us).
constexpr std::int64_t kMoversLifetime_us = 1'000'000;

// How far from the map's origin a candidate may be (m), as all positions.
bool is_near(double value) { return std::abs(value) <= bus::kMaxPosition_m; }

std::optional<std::vector<Pose3>> poses_of(const localisation_t& message) {
  std::vector<Pose3> poses;
  for (const pose_mode_t& mode : message.modes) {
    const auto& [x_m, y_m, yaw_rad] = mode.pose;
    const auto& [z_m, roll_rad, pitch_rad] = mode.tilt;
    if (!std::ranges::all_of(mode.pose, is_near) || !std::ranges::all_of(mode.tilt, is_near))
      return std::nullopt;
    poses.push_back(to_pose3(Pose2{x_m, y_m, yaw_rad}, Tilt{z_m, roll_rad, pitch_rad}));
  }
  return poses;
}

// Red, green, blue of a type of obstacle: as they are drawn elsewhere, the worse the redder.
std::array<std::uint8_t, 3> colour_of(std::int32_t type) {
  switch (type) {
    case obstacles_t::OVERHANG:
      return {240, 180, 40};
    case obstacles_t::NEGATIVE:
      return {170, 80, 220};
    default:
      return {230, 50, 40};
  }
}

// A grid's cells; nothing unless they are exactly as many.
std::optional<std::string> cells_of(const std::vector<std::uint8_t>& bytes, bool is_compressed,
                                    const std::int32_t (&dimensions)[2]) {
  const std::int64_t columns = dimensions[0], rows = dimensions[1];
  if (columns <= 0 || rows <= 0 || columns > kMostCells / rows) return std::nullopt;
  std::string cells(static_cast<std::size_t>(columns * rows), '\0');
  if (!is_compressed) {
    if (bytes.size() != cells.size()) return std::nullopt;
    std::ranges::transform(bytes, cells.begin(), [](auto b) { return static_cast<char>(b); });
    return cells;
  }
  auto size = static_cast<uLongf>(cells.size());
  const int result = uncompress(reinterpret_cast<Bytef*>(cells.data()), &size, bytes.data(),
                                static_cast<uLong>(bytes.size()));
  if (result != Z_OK || size != cells.size()) return std::nullopt;
  return cells;
}

struct GridPlace {
  std::int64_t utime_us;
  double x_m, y_m, cell_m;
};

std::optional<std::string> grid_at(const GridPlace& place, const std::int32_t (&dimensions)[2],
                                   const char* field, std::optional<std::string> cells) {
  // Written so that NaN fails.
  const bool sane = bus::is_sane_utime(place.utime_us) && is_near(place.x_m) &&
                    is_near(place.y_m) && place.cell_m > 0.0 && place.cell_m < 1e3;
  if (!sane || !cells) return std::nullopt;
  PackedGrid packed;
  packed.T_frame_corner.translation() = Eigen::Vector3d(place.x_m, place.y_m, 0.0);
  packed.cell_m = place.cell_m;
  packed.columns = static_cast<std::uint32_t>(dimensions[0]);
  packed.cells = {{{field, Type::kUint8}}, std::move(*cells)};
  return grid({place.utime_us, kMapFrame}, packed);
}

Level level_of(std::int32_t state) {
  if (state == health_t::STATE_OK) return Level::kInfo;
  return state == health_t::STATE_WARNING ? Level::kWarning : Level::kError;
}

std::string sentence_of(const localisation_t& message) {
  if (message.state == localisation_t::STATE_TRACKING) return "TRACKING";
  if (message.state == localisation_t::STATE_LOST) return "LOST";
  return fmt::format("AMBIGUOUS: {} places", message.modes.size());
}

}  // namespace

std::vector<PackedField> point_fields() {
  return {{"x", Type::kFloat32}, {"y", Type::kFloat32}, {"z", Type::kFloat32}};
}

void pack(const Eigen::Vector3d& point, Packed& to) {
  for (const double value : point) pack(static_cast<float>(value), to);
}

std::string cloud_message(const Cloud& cloud_base) {
  Packed points{point_fields(), {}};
  points.data.reserve(cloud_base.points.size() * stride_of(points.fields));
  for (const Eigen::Vector3f& point : cloud_base.points) pack(point.cast<double>(), points);
  return point_cloud({cloud_base.utime_us, kBaseFrame}, points);
}

std::optional<std::string> candidates_message(const localisation_t& message) {
  const auto poses = poses_of(message);
  if (!poses || !bus::is_sane_utime(message.utime)) return std::nullopt;
  return poses_in_frame({message.utime, kMapFrame}, *poses);
}

std::optional<std::string> candidate_points_message(const localisation_t& message) {
  const auto poses = poses_of(message);
  if (!poses || !bus::is_sane_utime(message.utime)) return std::nullopt;
  Packed points{point_fields(), {}};
  points.fields.push_back({"probability", Type::kFloat32});
  for (std::size_t i = 0; i < poses->size(); ++i) {
    pack((*poses)[i].translation(), points);
    pack(static_cast<float>(message.modes[i].probability), points);
  }
  return point_cloud({message.utime, kMapFrame}, points);
}

std::string state_message(const localisation_t& message) {
  const bool is_sure = message.state == localisation_t::STATE_TRACKING;
  return log_line(message.utime, is_sure ? Level::kInfo : Level::kWarning, "localiser",
                  sentence_of(message));
}

std::optional<std::string> obstacles_message(const obstacles_t& message) {
  if (!bus::is_sane_utime(message.utime)) return std::nullopt;
  Packed points{point_fields(), {}};
  for (const char* name : {"red", "green", "blue", "alpha", "type"})
    points.fields.push_back({name, Type::kUint8});
  for (std::size_t i = 0; i < message.cells.size(); ++i) {
    pack(Eigen::Vector3d(message.cells[i][0], message.cells[i][1], 0.0), points);
    for (const std::uint8_t part : colour_of(message.types[i])) pack(part, points);
    pack(std::uint8_t{255}, points);
    pack(static_cast<std::uint8_t>(message.types[i]), points);
  }
  return point_cloud({message.utime, kBaseFrame}, points);
}

std::optional<std::string> movers_message(const obstacles_t& message) {
  if (!bus::is_sane_utime(message.utime)) return std::nullopt;
  std::vector<Mover> all;
  for (const moving_obstacle_t& m : message.moving) {
    const auto is_sane = [](float value) { return is_near(value); };
    if (!std::ranges::all_of(m.position, is_sane) || !std::ranges::all_of(m.velocity, is_sane) ||
        !is_near(m.radius_m))
      return std::nullopt;
    all.push_back({{m.position[0], m.position[1]}, {m.velocity[0], m.velocity[1]}, m.radius_m});
  }
  return movers({message.utime, kBaseFrame}, all, kMoversLifetime_us);
}

std::optional<std::string> scan_message(const planar_lidar_t& message) {
  const auto is_sane = [](float rad) { return std::abs(rad) < 100.0F; };
  if (!bus::is_sane_utime(message.utime) || !is_sane(message.rad0) || !is_sane(message.radstep))
    return std::nullopt;
  return laser_scan({message.utime, kBaseFrame}, {message.rad0, message.radstep, message.ranges});
}

std::optional<std::string> grid_message(const pixel_map_t& message) {
  if (message.data_type != pixel_map_t::DATA_TYPE_UINT8) return std::nullopt;
  return grid_at({message.utime, message.xy0[0], message.xy0[1], message.mpp}, message.dimensions,
                 "occupancy",
                 cells_of(message.mapData, message.compressed != 0, message.dimensions));
}

std::optional<std::string> grid_message(const traversability_t& message) {
  return grid_at({message.utime, message.xy0[0], message.xy0[1], message.resolution_m},
                 message.dimensions, "type",
                 cells_of(message.cells, message.compressed != 0, message.dimensions));
}

std::string health_message(const health_t& message) {
  return log_line(message.utime, level_of(message.state), message.service,
                  message.message.empty() ? "all is well" : message.message);
}

std::optional<StampedPose3> transform_of(const rigid_transform_t& message) {
  pose_t same{};
  same.utime = message.utime;
  std::ranges::copy(message.trans, same.pos);
  std::ranges::copy(message.quat, same.orientation);
  return bus::from_message(same);
}

}  // namespace voxlist::foreign
