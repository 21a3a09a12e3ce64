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

#include "services/mapper/mapper_service.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::services {

inline constexpr std::int64_t kSecond_us = 1'000'000;

/// A wall 2 m before the robot.
inline Cloud cloud_at(std::int64_t utime_us) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  for (int i = 0; i < 200; ++i) cloud.points.emplace_back(2.f, 0.03f * float(i), 0.5f);
  return cloud;
}

/// The service with a folder, and a test that plays localiser and listeners.
struct WallScene {
  explicit WallScene(const std::string& folder, bool extend = true,
                     TiltUse tilt = TiltUse::kPlanar) {
    MapperServiceConfig config;
    config.tilt = tilt;
    config.folder = folder;
    config.extend = extend;
    bus.subscribe(bus::kMapUpdate, [this](const map_update_t& m) { take(m); });
    bus.subscribe(bus::kKeyframe, [this](const keyframe_t& m) { keyframes.push_back(m); });
    service.emplace(bus, health, config);
  }

  void take(const map_update_t& message) {
    updates.push_back(message);
    for (const bus::MapChange& change : assembler.add(message)) bus::apply(change, map);
  }

  void run() {
    for (int i = 0; i < 3; ++i) {
      bus.handle(std::chrono::milliseconds(0));
      service->tick(now_us += 20'000);
    }
    bus.handle(std::chrono::milliseconds(0));
  }

  void request(std::int32_t want, std::int32_t first = 0) {
    map_request_t message{};
    message.want = want;
    message.first = first;
    bus.publish(bus::kMapRequest, message);
    run();
  }

  void request_new_map(std::int64_t map_id) {
    map_request_t message{};
    message.utime = now_us;
    message.want = map_request_t::WANT_NEW_MAP;
    message.map_id = map_id;
    bus.publish(bus::kMapRequest, message);
    run();
  }

  // A cloud, and what the localiser says of it.
  void drive(std::int64_t second, const Pose2& pose,
             std::int32_t state = localisation_t::STATE_TRACKING, const Tilt& tilt = {}) {
    bus.publish(bus::kCloud, bus::to_message(cloud_at(second * kSecond_us), "base", 0));
    localisation_t message{};
    message.utime = second * kSecond_us;
    message.map_id = assembler.held()->map_id;
    message.map_version = assembler.held()->version;
    message.state = state;
    message.n_modes = 1;
    message.modes.resize(1);
    message.modes[0].pose[0] = pose.x_m;
    message.modes[0].pose[1] = pose.y_m;
    message.modes[0].pose[2] = pose.yaw_rad;
    message.modes[0].tilt[0] = tilt.z_m;
    message.modes[0].tilt[1] = tilt.roll_rad;
    message.modes[0].tilt[2] = tilt.pitch_rad;
    bus.publish(bus::kLocalisation, message);
    run();
  }

  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health{"mapper"};
  std::optional<MapperService> service;
  std::int64_t now_us = 1'700'000'000 * kSecond_us;
  bus::MapAssembler assembler;
  OccupancyMap map;
  std::vector<map_update_t> updates;
  std::vector<keyframe_t> keyframes;
};

}  // namespace voxlist::services
