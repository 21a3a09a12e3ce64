// Writes an event log of what the localiser and the obstacle detector say of a robot that drives
// through a room whose map they have: CLOUD, POSE, LOCALISATION and OBSTACLES, ten of each.
// Usage: record_room LOG
#include <chrono>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/obstacles_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/localiser/localiser_service.h"
#include "services/obstacle_detector/obstacle_detector_service.h"
#include "tests/stand_in_mapper.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/map_convert.h"

namespace voxlist::services {
namespace {

constexpr int kClouds = 10;
constexpr std::int64_t kSecond_us = 1'000'000;
constexpr std::int64_t kStart_us = 1'700'000'000 * kSecond_us;

// Walls of different lengths and a box, in map.
Cloud room() {
  Cloud cloud;
  for (float s = -3.F; s < 3.F; s += 0.06F) {
    for (float z = 0.F; z < 2.F; z += 0.1F) {
      cloud.points.emplace_back(s, 2.5F, z);
      cloud.points.emplace_back(3.F, s, z);
      if (s < 1.F) cloud.points.emplace_back(-3.F, s, z);
      if (s < -1.F) cloud.points.emplace_back(s, -2.F, z);
      if (s > 0.F && s < 0.5F) cloud.points.emplace_back(s + 1.F, 1.5F, z);
    }
  }
  return cloud;
}

// The room as the robot sees it after i seconds: it drives at 0.1 m/s, and turns.
Cloud seen(int i) {
  const Pose3 T_map_base = Eigen::Translation3d(0.1 * i, 0.0, 0.0) *
                           Eigen::AngleAxisd(0.02 * i, Eigen::Vector3d::UnitZ());
  Cloud cloud = room();
  cloud.utime_us = kStart_us + i * kSecond_us;
  for (auto& point : cloud.points)
    point = (T_map_base.inverse() * point.cast<double>()).cast<float>();
  return cloud;
}

bus::MapChange map_of_room() {
  OccupancyMap map;
  add_scan(room(), Pose3::Identity(), 100.0, map);
  bus::MapChange change;
  change.map_id = 7;
  change.version = 1;
  change.resolution = bus::resolution_of(map);
  change.blocks = bus::to_messages(map);
  return change;
}

// A service on a bus of its own; what it says goes into the log.
template <class Service, class Config>
class Recorded {
 public:
  explicit Recorded(bus::EventLogWriter& log) : log_(log), service_(bus_, health_, Config{}) {}

  template <class M>
  void record(bus::Channel<M> channel) {
    bus_.subscribe(channel, [this, channel](const M& message) {
      log_.write(channel, message.utime, message);
    });
  }

  template <class M>
  void hear(bus::Channel<M> channel, const M& message) {
    bus_.publish(channel, message);
    bus_.handle(std::chrono::milliseconds(0));
    run(message.utime);
  }

  void run(std::int64_t now_us) {
    service_.tick(now_us);
    bus_.handle(std::chrono::milliseconds(0));
  }

  void ask(const test::StandInMapper& mapper) {
    bus_.subscribe(bus::kMapRequest, [&](const map_request_t& message) {
      for (const auto& part : mapper.answer(message)) bus_.publish(bus::kMapUpdate, part);
    });
  }

 private:
  bus::EventLogWriter& log_;
  bus::Bus bus_{{.url = "memq://", .prefix = ""}};
  bus::Health health_{"record_room"};
  Service service_;
};

void record(const std::string& path) {
  bus::EventLogWriter log(path);
  Recorded<LocaliserService, LocaliserServiceConfig> localiser(log);
  localiser.record(bus::kPose);
  localiser.record(bus::kLocalisation);
  Recorded<ObstacleDetectorService, planning::ObstacleConfig> detector(log);
  detector.record(bus::kObstacles);
  test::StandInMapper mapper(map_of_room());
  localiser.ask(mapper);
  for (int i = 0; i < 3; ++i) localiser.run(kStart_us);
  for (int i = 0; i < kClouds; ++i) {
    const pointcloud_t cloud = bus::to_message(seen(i), "base", i);
    log.write(bus::kCloud, cloud.utime, cloud);
    localiser.hear(bus::kCloud, cloud);
    mapper.map().utime_us = cloud.utime;
    for (const auto& part : mapper.word()) localiser.hear(bus::kMapUpdate, part);
    detector.hear(bus::kCloud, cloud);
  }
  log.close();
}

}  // namespace
}  // namespace voxlist::services

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  voxlist::services::record(argv[1]);
}
