#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/mapper/mapper_service.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::services {

/// The mapper with a folder, and a test that plays localiser, wheels and listener.
class MapperScene {
 public:
  explicit MapperScene(const std::string& folder, MapperServiceConfig config = {}) {
    config.folder = folder;
    config.close_loops = LoopUse::kOnStop;
    config.last_loops_s = 600.0;  // however slow the machine is
    config.builder.min_news = 0.0;
    bus_.subscribe(bus::kMapUpdate, [this](const map_update_t& m) { take(m); });
    service.emplace(bus_, health_, config);
    map_request_t request{};
    request.want = map_request_t::WANT_MAP;
    bus_.publish(bus::kMapRequest, request);
    run();
  }

  void run() {
    for (int i = 0; i < 30; ++i) {  // large changes are sent in paces
      bus_.handle(std::chrono::milliseconds(0));
      service->tick(now_us_ += 20'000);
    }
    bus_.handle(std::chrono::milliseconds(0));
  }

  void odometry(std::int64_t utime_us, const Pose2& T_odom_base) {
    bus_.publish(bus::kOdometry, bus::to_message(StampedPose2{utime_us, T_odom_base}));
  }

  std::string health() const { return health_.message(); }

  // A cloud, and what the localiser says of it.
  void drive(const mapping::Keyframe& keyframe,
             std::int32_t state = localisation_t::STATE_TRACKING) {
    bus_.publish(bus::kCloud, bus::to_message(keyframe.cloud, "base", 0));
    localisation_t message{};
    message.utime = keyframe.cloud.utime_us;
    message.map_id = assembler.held()->map_id;
    message.map_version = assembler.held()->version;
    message.state = state;
    message.confidence = state == localisation_t::STATE_TRACKING ? 0.999 : 0.0;
    message.n_modes = 1;
    message.modes.resize(1);
    const Pose2 pose = to_pose2(keyframe.T_map_base);
    message.modes[0].pose[0] = pose.x_m;
    message.modes[0].pose[1] = pose.y_m;
    message.modes[0].pose[2] = pose.yaw_rad;
    bus_.publish(bus::kLocalisation, message);
    run();
  }

  std::optional<MapperService> service;
  bus::MapAssembler assembler;
  OccupancyMap map;
  std::vector<bus::MapChange> changes;

 private:
  void take(const map_update_t& message) {
    for (bus::MapChange& change : assembler.add(message)) {
      bus::apply(change, map);
      changes.push_back(std::move(change));
    }
  }

  bus::Bus bus_{{.url = "memq://", .prefix = ""}};
  bus::Health health_{"mapper"};
  std::int64_t now_us_ = 1'700'000'000'000'000;
};

}  // namespace voxlist::services
