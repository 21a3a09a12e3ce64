// FREE_SPACE from the mapper to a planner, over a line that loses, mixes up and makes up messages.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>

#include "services/mapper/mapper_service.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/map_convert.h"
#include "voxlist/service/inputs/map_follower.h"

namespace voxlist::services {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;
constexpr std::uint32_t kSeed = 20'261'129;

// A scan of a round room.
Cloud cloud_at(std::int64_t utime_us) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  for (int i = 0; i < 400; ++i) {
    const float angle = 0.37F * float(i);
    cloud.points.emplace_back(3.0F * std::cos(angle), 3.0F * std::sin(angle),
                              0.005F * float(i % 300));
  }
  return cloud;
}

// What a service that makes grids does: it follows FREE_SPACE and nothing else.
class Planner {
 public:
  void take(const map_update_t& message) {
    for (const bus::MapChange& change : follower.take(message)) bus::apply(change, space);
  }

  std::int64_t version() const { return follower.held() ? follower.held()->version : -1; }

  bus::Health health{"planner"};
  service::MapFollower follower{health, service::kFreeSpaceSource};
  OccupancyMap space;
};

class FreeSpaceOnTheBus : public testing::Test {
 protected:
  FreeSpaceOnTheBus() {
    bus_.subscribe(bus::kFreeSpace, [this](const map_update_t& m) { line_.push_back(m); });
    bus_.subscribe(bus::kMapUpdate, [this](const map_update_t& m) {
      map_id_ = m.map_id;
      version_ = m.version;
    });
    MapperServiceConfig config;
    config.folder = "";
    mapper_.emplace(bus_, mapper_health_, config);
  }

  void run(double seconds) {
    const std::int64_t end_us = now_us_ + std::int64_t(seconds * 1e6);
    for (; now_us_ < end_us; now_us_ += 20'000) {
      if (const auto request = planner_.follower.tick(now_us_); request && is_listening_)
        bus_.publish(bus::kMapRequest, *request);
      bus_.handle(std::chrono::milliseconds(0));
      mapper_->tick(now_us_);
      bus_.handle(std::chrono::milliseconds(0));
      deliver();
    }
  }

  void deliver() {
    sent_ += line_.size();
    if (is_bad_) std::shuffle(line_.begin(), line_.end(), random_);
    for (const map_update_t& message : line_) {
      if (is_bad_ && random_() % 3 == 0) continue;
      if (is_bad_ && random_() % 4 == 0) forge(message);
      planner_.take(message);
    }
    line_.clear();
  }

  void forge(map_update_t message) {
    message.answers = 0;
    switch (random_() % 3) {
      case 0:
        message.map_id += 1;
        break;
      case 1:
        message.version += 5;
        break;
      default:
        message.resolution_m = 1e9;
    }
    planner_.take(message);
  }

  void drive(int second, double x_m) {
    bus_.publish(bus::kCloud, bus::to_message(cloud_at(second * kSecond_us), "base", 0));
    localisation_t message{};
    message.utime = second * kSecond_us;
    message.map_id = map_id_;
    message.map_version = version_;
    message.state = localisation_t::STATE_TRACKING;
    message.n_modes = 1;
    message.modes.resize(1);
    message.modes[0].pose[0] = x_m;
    bus_.publish(bus::kLocalisation, message);
    run(0.2);
  }

  // What the mapper must have counted.
  void expect_all(int keyframes) {
    mapping::MapBuilder builder({.count_free = true});
    for (int i = 0; i < keyframes; ++i)
      builder.add({to_pose3({0.8 * i, 0.0, 0.0}), cloud_at((i + 1) * kSecond_us)});
    EXPECT_EQ(planner_.version(), keyframes);
    EXPECT_GT(builder.free_space().passed.size(), 5000u);
    EXPECT_EQ(planner_.space.passed.hash(), builder.free_space().passed.hash());
    EXPECT_EQ(planner_.space.occupied.hash(), builder.free_space().occupied.hash());
  }

  bus::Bus bus_{{.url = "memq://", .prefix = ""}};
  bus::Health mapper_health_{"mapper"};
  std::optional<MapperService> mapper_;
  Planner planner_;
  std::vector<map_update_t> line_;
  std::size_t sent_ = 0;
  bool is_bad_ = false, is_listening_ = true;
  std::mt19937 random_{kSeed};
  std::int64_t now_us_ = 1'700'000'000 * kSecond_us, map_id_ = 0, version_ = 0;
};

TEST_F(FreeSpaceOnTheBus, GrowsWithTheMap) {
  run(0.5);
  for (int i = 0; i < 6; ++i) drive(i + 1, 0.8 * i);
  expect_all(6);
}

TEST_F(FreeSpaceOnTheBus, IsSentToWhoComesLater) {
  is_listening_ = false;
  run(0.1);
  for (int i = 0; i < 6; ++i) drive(i + 1, 0.8 * i);
  EXPECT_EQ(sent_, 0u) << "nobody has asked";
  is_listening_ = true;
  run(1.0);
  expect_all(6);
}

TEST_F(FreeSpaceOnTheBus, IsWholeOverABadLine) {
  is_bad_ = true;
  run(0.5);
  for (int i = 0; i < 12; ++i) drive(i + 1, 0.8 * i);
  run(20.0);
  expect_all(12);
}

TEST_F(FreeSpaceOnTheBus, TellsOnlyWhatChanged) {
  run(0.5);
  for (int i = 0; i < 3; ++i) drive(i + 1, 0.8 * i);
  sent_ = 0;
  const std::uint64_t before = planner_.space.passed.hash();
  drive(4, 1.6);  // not far enough to be looked at
  EXPECT_EQ(sent_, 1u) << "that nothing changed";
  EXPECT_EQ(planner_.space.passed.hash(), before);
  EXPECT_EQ(planner_.version(), 3);
}

}  // namespace
}  // namespace voxlist::services
