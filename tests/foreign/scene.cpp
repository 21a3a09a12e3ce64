#include "tests/foreign/scene.h"

#include <zlib.h>

#include <stdexcept>
#include <voxlist/health_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pixel_map_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/rigid_transform_t.hpp>
#include <voxlist/traversability_t.hpp>

#include "voxlist/bus/channels.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/maps/map_convert.h"
#include "voxlist/bus/wire.h"

namespace voxlist::test {
namespace {

constexpr std::int64_t kMapId = 7;

// One side of a corridor and a post, as the robot at x = 0 sees them.
Cloud seen(std::int64_t utime_us) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  for (float x = -2.F; x < 2.F; x += 0.05F)
    for (float z = 0.F; z < 2.F; z += 0.1F) {
      cloud.points.emplace_back(x, 1.5F, z);
      if (x > 1.9F) cloud.points.emplace_back(1.F, x - 3.F, z);
    }
  return cloud;
}

std::vector<std::uint8_t> compressed(const std::vector<std::uint8_t>& bytes) {
  std::vector<std::uint8_t> packed(compressBound(static_cast<uLong>(bytes.size())));
  auto size = static_cast<uLongf>(packed.size());
  compress(packed.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()));
  packed.resize(size);
  return packed;
}

class Scene {
 public:
  std::vector<SceneMessage> take() {
    for (int second = 0; second < kSeconds; ++second) say(second);
    return std::move(messages_);
  }

 private:
  template <class M>
  void add(const std::string& channel, const M& message) {
    SceneMessage added{channel, utime_us_, {}};
    if (bus::encode(message, added.bytes) != bus::Fault::kNone)
      throw std::logic_error(channel + " cannot be encoded");
    messages_.push_back(std::move(added));
  }

  void say(int second) {
    utime_us_ = kSceneStart_us + second * 1'000'000;
    pose_ = Pose2{x_m(second), 0.0, 0.0};
    const Cloud cloud = seen(utime_us_);
    add(bus::kCloud.name, bus::to_message(cloud, "base", second));
    add(bus::kCloudSlice.name, bus::to_message(cloud, "base", second));
    for (const auto& channel : {bus::kPose, bus::kOdometry, bus::kTruth})
      add(channel.name, bus::to_message(StampedPose2{utime_us_, pose_}));
    add(bus::kMapOdom.name, bus::to_transform({utime_us_, Pose2{0.1, 0.0, 0.0}}));
    say_localisation(second + 1 < kSeconds ? 1 : kPlaces);
    say_map(second, cloud);
    say_obstacles();
    say_grids();
    say_scans();
    say_health(second);
  }

  void say_localisation(int places) {
    localisation_t message{};
    message.utime = utime_us_;
    constexpr std::int32_t kSure = localisation_t::STATE_TRACKING;
    constexpr std::int32_t kUnsure = localisation_t::STATE_AMBIGUOUS;
    message.state = places == 1 ? kSure : kUnsure;
    message.n_modes = places;
    message.modes.resize(static_cast<std::size_t>(places));
    for (int i = 0; i < places; ++i) {
      pose_mode_t& mode = message.modes[static_cast<std::size_t>(i)];
      mode.pose[0] = pose_.x_m + 5.0 * i;
      mode.probability = 0.9 / places;
    }
    add(bus::kLocalisation.name, message);
  }

  void say_map(int second, const Cloud& cloud) {
    const OccupancyMap before = map_;
    add_scan(cloud, to_pose3(pose_), 30.0, map_);
    bus::MapChange change;
    change.utime_us = utime_us_;
    change.map_id = kMapId;
    change.version = second + 1;
    change.base_version = second;
    change.resolution = bus::resolution_of(map_);
    if (second == 0) change.base_version = bus::kWholeMap;
    change.blocks =
        second == 0 ? bus::to_messages(map_) : bus::to_messages(map_, difference(before, map_));
    for (const map_update_t& message : bus::split_map(change)) add(bus::kMapUpdate.name, message);
    say_space(change);
  }

  // Twice as many free cells as occupied ones, in halves of one block.
  void say_space(bus::MapChange change) {
    OccupancyMap cells{VoxelMap(0.08), VoxelMap(0.08)};
    for (std::int32_t x = 0; x < 8; ++x)
      for (std::int32_t y = 0; y < 6; ++y)
        (y < 4 ? cells.passed : cells.occupied).insert({x, y, 0});
    change.resolution = bus::resolution_of(cells);
    change.base_version = bus::kWholeMap;
    change.blocks = bus::to_messages(cells);
    for (const map_update_t& message : bus::split_map(change)) add(bus::kFreeSpace.name, message);
  }

  void say_scans() {
    planar_lidar_t scan{};
    scan.utime = utime_us_;
    scan.rad0 = -1.0F;
    scan.radstep = 0.5F;
    scan.ranges = {1.0F, 2.0F, 3.0F, 4.0F, 5.0F};
    scan.nranges = static_cast<std::int32_t>(scan.ranges.size());
    add("SCAN_low", scan);
    add("SCAN_FAR_low", scan);
  }

  void say_obstacles() {
    obstacles_t message{};
    message.utime = utime_us_;
    message.n_bearings = 1;
    message.nearest_m.assign(3, {1.5F});
    message.ground_seen_to_m = {1.5F};
    message.n_cells = 3;
    message.cells = {{1.F, 0.F}, {1.F, 0.5F}, {2.F, 0.F}};
    message.types = {obstacles_t::OBSTACLE, obstacles_t::OVERHANG, obstacles_t::NEGATIVE};
    message.moving.resize(1);
    message.moving[0].position[0] = 2.0F;
    message.moving[0].velocity[1] = 0.5F;
    message.moving[0].radius_m = 0.3F;
    message.n_moving = 1;
    add(bus::kObstacles.name, message);
  }

  void say_grids() {
    std::vector<std::uint8_t> cells(kGridColumns * kGridRows);
    for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = static_cast<std::uint8_t>(i);
    pixel_map_t grid{};
    grid.utime = utime_us_;
    grid.dimensions[0] = kGridColumns;
    grid.dimensions[1] = kGridRows;
    grid.xy0[0] = -1.0;
    grid.mpp = 0.5;
    grid.data_type = pixel_map_t::DATA_TYPE_UINT8;
    grid.datasize = static_cast<std::int32_t>(cells.size());
    grid.mapData = cells;
    add("GRID_low", grid);
    traversability_t types{};
    types.utime = utime_us_;
    types.profile = "low";
    types.resolution_m = 0.5;
    types.dimensions[0] = kGridColumns;
    types.dimensions[1] = kGridRows;
    types.compressed = 1;
    types.cells = compressed(cells);
    types.datasize = static_cast<std::int32_t>(types.cells.size());
    add("TRAVERSABILITY_low", types);
  }

  void say_health(int second) {
    health_t message{};
    message.utime = utime_us_;
    message.service = "mapper";
    constexpr std::int32_t kOk = health_t::STATE_OK, kWarning = health_t::STATE_WARNING;
    message.state = second < kSeconds / 2 ? kOk : kWarning;
    message.message = second < kSeconds / 2 ? "" : "the disk is nearly full";
    add(bus::kHealth.name, message);
  }

  std::vector<SceneMessage> messages_;
  std::int64_t utime_us_ = 0;
  Pose2 pose_;
  OccupancyMap map_;
};

}  // namespace

std::vector<SceneMessage> scene() { return Scene().take(); }

int points_of_cloud() { return static_cast<int>(seen(0).points.size()); }

double x_m(int second) { return 0.5 * second; }

}  // namespace voxlist::test
