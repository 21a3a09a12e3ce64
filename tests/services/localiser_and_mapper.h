#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/localiser/localiser_service.h"
#include "services/mapper/mapper_service.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"

namespace voxlist::services {

/// A service on a bus of its own.
template <class Service, class Config>
struct Side {
  Side(const char* name, const Config& config) : health(name), service(bus, health, config) {}

  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health;
  Service service;
};

/// Localiser and mapper, and a network between them.
class LocaliserAndMapper {
 public:
  explicit LocaliserAndMapper(std::string folder) : folder_(std::move(folder)) {
    start_mapper();
    start_localiser();
  }

  /// In the place of the one that runs, which does not end well.
  void start_mapper() {
    mapper.reset();
    MapperServiceConfig config;
    config.folder = folder_;
    mapper.emplace("mapper", config);
    mapper->bus.subscribe(bus::kMapUpdate, [this](const map_update_t& m) {
      if (localiser) localiser->bus.publish(bus::kMapUpdate, m);
    });
  }

  void start_localiser() {
    localiser.emplace("localiser", LocaliserServiceConfig{});
    localiser->bus.subscribe(bus::kLocalisation, [this](const localisation_t& m) {
      answers.push_back(m);
      mapper->bus.publish(bus::kLocalisation, m);
    });
    localiser->bus.subscribe(bus::kPose, [this](const pose_t& m) { poses.push_back(m); });
    localiser->bus.subscribe(bus::kMapRequest, [this](const map_request_t& m) {
      mapper->bus.publish(bus::kMapRequest, m);
    });
    run(0.5);
  }

  void run(double seconds) {
    for (const std::int64_t end_us = now_us_ + std::llround(seconds * 1e6); now_us_ < end_us;) {
      now_us_ += 10'000;
      localiser->bus.handle(std::chrono::milliseconds(0));
      localiser->service.tick(now_us_);
      mapper->bus.handle(std::chrono::milliseconds(0));
      mapper->service.tick(now_us_);
    }
  }

  /// Both hear a cloud, and have a second. Returns its utime.
  std::int64_t send(Cloud cloud) {
    cloud.utime_us = now_us_;
    for (bus::Bus* bus : {&localiser->bus, &mapper->bus})
      bus->publish(bus::kCloud, bus::to_message(cloud, "base", seq_));
    ++seq_;
    run(1.0);
    return cloud.utime_us;
  }

  std::optional<Side<MapperService, MapperServiceConfig>> mapper;
  std::optional<Side<LocaliserService, LocaliserServiceConfig>> localiser;
  /// All that were published.
  std::vector<localisation_t> answers;
  std::vector<pose_t> poses;

 private:
  const std::string folder_;
  std::int64_t now_us_ = 1'700'000'000'000'000;
  std::int32_t seq_ = 0;
};

}  // namespace voxlist::services
