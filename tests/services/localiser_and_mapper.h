#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/localiser/localiser_service.h"
#include "services/mapper/mapper_service.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"

namespace voxlist::services {

// A service on a bus of its own.
template <class Service, class Config>
struct Side {
  Side(const char* name, const Config& config) : health(name), service(bus, health, config) {}

  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health;
  Service service;
};

// Localiser and mapper, and a network between them.
class LocaliserAndMapper : public testing::Test {
 protected:
  LocaliserAndMapper() {
    start_mapper();
    start_localiser();
  }

  void start_mapper() {
    mapper_.reset();
    MapperServiceConfig config;
    config.folder = folder_.string();
    mapper_.emplace("mapper", config);
    mapper_->bus.subscribe(bus::kMapUpdate, [this](const map_update_t& m) {
      if (localiser_) localiser_->bus.publish(bus::kMapUpdate, m);
    });
  }

  void start_localiser() {
    localiser_.emplace("localiser", LocaliserServiceConfig{});
    localiser_->bus.subscribe(bus::kLocalisation, [this](const localisation_t& m) {
      answers_.push_back(m);
      mapper_->bus.publish(bus::kLocalisation, m);
    });
    localiser_->bus.subscribe(bus::kPose, [this](const pose_t& m) { poses_.push_back(m); });
    localiser_->bus.subscribe(bus::kMapRequest, [this](const map_request_t& m) {
      mapper_->bus.publish(bus::kMapRequest, m);
    });
    run(0.5);
  }

  void run(double seconds) {
    for (const std::int64_t end_us = now_us_ + std::llround(seconds * 1e6); now_us_ < end_us;) {
      now_us_ += 10'000;
      localiser_->bus.handle(std::chrono::milliseconds(0));
      localiser_->service.tick(now_us_);
      mapper_->bus.handle(std::chrono::milliseconds(0));
      mapper_->service.tick(now_us_);
    }
  }

  // Returns its utime.
  std::int64_t send(Cloud cloud, const std::optional<Pose2>& T_odom_base = std::nullopt) {
    cloud.utime_us = now_us_;
    for (bus::Bus* bus : {&localiser_->bus, &mapper_->bus}) {
      if (T_odom_base)
        bus->publish(bus::kOdometry, bus::to_message(StampedPose2{now_us_, *T_odom_base}));
      bus->publish(bus::kCloud, bus::to_message(cloud, "base", seq_));
    }
    ++seq_;
    run(1.0);
    return cloud.utime_us;
  }

  const localisation_t* answer_to(std::int64_t utime_us) const {
    const localisation_t* found = nullptr;
    for (const localisation_t& answer : answers_) {
      if (answer.utime != utime_us) continue;
      EXPECT_EQ(found, nullptr) << "answered twice";
      found = &answer;
    }
    return found;
  }

  const test::TemporaryFolder folder_;
  std::optional<Side<LocaliserService, LocaliserServiceConfig>> localiser_;
  std::optional<Side<MapperService, MapperServiceConfig>> mapper_;
  std::vector<localisation_t> answers_;
  std::vector<pose_t> poses_;
  std::int64_t now_us_ = 1'700'000'000'000'000;
  std::int32_t seq_ = 0;
};

}  // namespace voxlist::services
