#include "services/obstacle_detector/obstacle_detector_service.h"

#include <voxlist/mirror_state_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/obstacle_detector/obstacles_message.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/geometry/tilt.h"

namespace voxlist::services {
namespace {

// While slices come, CLOUD brings the same points once more. When none came for so long (us), CLOUD
// is looked at.
constexpr std::int64_t kSlicesCome_us = 2'000'000;

// How often OBSTACLES says that it is blind (us): as often as slices come.
constexpr std::int64_t kPeriod_us = 66'667;

}  // namespace

ObstacleDetectorService::ObstacleDetectorService(bus::Bus& bus, bus::Health& health,
                                                 const planning::ObstacleConfig& config)
    : bus_(bus),
      health_(health),
      config_(config),
      finder_(config),
      blindness_(config.min_range_m),
      clouds_(health, service::CloudInput::Sees::kTheNewest),
      slices_(health, {.channel = bus::kCloudSlice.name, .remedy = "", .is_needed = false}),
      odometry_(health, {.channel = bus::kOdometry.name,
                         .remedy = "",
                         .is_needed = false,
                         .disorder_us = OdometryBuffer::kMaxAge_us}) {
  bus_.subscribe(bus::kCloudSlice, [this](const pointcloud_t& m) { take_slice(m); });
  bus_.subscribe(
      bus::kCloud, [this](const pointcloud_t& m) { take_cloud(m); }, bus::Delivery::kLatest);
  bus_.subscribe(bus::kOdometry, [this](const pose_t& m) { take_odometry(m); });
  bus_.subscribe(
      bus::kMirror, [this](const mirror_state_t& m) { take_mirror(m); }, bus::Delivery::kLatest);
}

void ObstacleDetectorService::check(const planning::ObstacleConfig& config) {
  planning::ObstacleFinder{config};
}

void ObstacleDetectorService::take_slice(const pointcloud_t& message) {
  slice_us_ = now_us_;
  if (!slices_.take(message.utime)) return;
  slices_.take_number(message.seq);
  const bus::ReceivedCloud received = bus::from_message(message);
  if (!received.cloud) return health_.count("CLOUD_SLICE/" + received.refusal);
  if (received.dropped_points > 0)
    health_.count("CLOUD_SLICE/dropped_points", received.dropped_points);
  look(*received.cloud, Part::kSlice);
}

void ObstacleDetectorService::take_cloud(const pointcloud_t& message) {
  const std::optional<Cloud> cloud = clouds_.take(message);
  const bool slices_come = slice_us_ && now_us_ - *slice_us_ <= kSlicesCome_us;
  if (cloud && !slices_come) look(*cloud, Part::kWhole);
}

void ObstacleDetectorService::take_odometry(const pose_t& message) {
  if (!odometry_.take(message.utime)) return;
  const auto pose = bus::from_message(message);
  if (!pose) return health_.count("ODOMETRY/not_a_pose");
  finder_.add_odometry({pose->utime_us, to_pose2(pose->pose)}, tilt_of(pose->pose));
}

void ObstacleDetectorService::take_mirror(const mirror_state_t& message) {
  const auto state = bus::from_message(message);
  if (!state) return health_.count("MIRROR/not_a_state");
  blindness_.take(*state, now_us_);
}

void ObstacleDetectorService::look(const Cloud& cloud, Part part) {
  last_ = {cloud.utime_us, now_us_};
  blindness_.take(cloud, now_us_);
  const planning::ObstacleScan scan = finder_.take(cloud, part);
  const std::string blind = blindness_.why(now_us_);
  publish(blind.empty() ? scan : nothing_seen(cloud.utime_us, config_), blind);
  arrival_us_ = bus_.arrival_utime_us();
}

void ObstacleDetectorService::publish(const planning::ObstacleScan& scan,
                                      const std::string& blind) {
  health_.raise("blind", bus::Health::State::kError, blind);
  bus_.publish(bus::kObstacles, to_message(scan, blind, config_));
  published_us_ = now_us_;
}

// The data's time that belongs to a time of this machine.
std::int64_t ObstacleDetectorService::utime_at(std::int64_t now_us) const {
  return last_ ? last_->utime_us + now_us - last_->came_us : now_us;
}

void ObstacleDetectorService::tick(std::int64_t now_us) {
  now_us_ = now_us;
  clouds_.tick(now_us);
  slices_.tick(now_us);
  odometry_.tick(now_us);
  if (arrival_us_) health_.add_latency_us(now_us - *arrival_us_);
  arrival_us_.reset();
  if (published_us_ && now_us - *published_us_ < kPeriod_us) return;
  const std::string blind = blindness_.why(now_us);
  if (!blind.empty()) publish(nothing_seen(utime_at(now_us), config_), blind);
}

}  // namespace voxlist::services
