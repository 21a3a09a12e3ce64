#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/localisation_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_hint_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/rigid_transform_t.hpp>
#include <voxlist/uncertain_pose_t.hpp>

#include "services/localiser/localiser_service.h"
#include "tests/stand_in_mapper.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/bus/maps/map_convert.h"
#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/tilt.h"

namespace voxlist::services {
namespace {

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

// Walls and a few boxes, as seen from the middle.
Cloud room(std::int64_t utime_us) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  for (float s = -3.f; s < 3.f; s += 0.06f) {
    for (float z = 0.f; z < 2.f; z += 0.1f) {
      cloud.points.emplace_back(s, 2.5f, z);
      cloud.points.emplace_back(3.f, s, z);
      if (s < 1.f) cloud.points.emplace_back(-3.f, s, z);
      if (s < -1.f) cloud.points.emplace_back(s, -2.f, z);
      if (s > 0.f && s < 0.5f) cloud.points.emplace_back(s + 1.f, 1.5f, z);
    }
  }
  return cloud;
}

// The service, and a test that plays the sensors and the mapper.
struct Scene {
  explicit Scene(const LocaliserServiceConfig& config = {}) : service(bus, health, config) {
    bus.subscribe(bus::kLocalisation, [this](const localisation_t& m) {
      localisations.push_back(m);
      poses_when_told.push_back(poses.size());
    });
    bus.subscribe(bus::kPose, [this](const pose_t& m) { poses.push_back(m); });
    bus.subscribe(bus::kPoseCovariance,
                  [this](const uncertain_pose_t& m) { covariances.push_back(m); });
    bus.subscribe(bus::kMapOdom, [this](const rigid_transform_t& m) { map_odom.push_back(m); });
    bus.subscribe(bus::kMapRequest, [this](const map_request_t& m) {
      requests.push_back(m);
      if (mapper) publish(mapper->answer(m));
    });
  }

  void run(std::int64_t now_us) {
    bus.handle(std::chrono::milliseconds(0));
    service.tick(now_us);
    bus.handle(std::chrono::milliseconds(0));
  }

  void publish(const std::vector<map_update_t>& messages) {
    for (const map_update_t& message : messages) bus.publish(bus::kMapUpdate, message);
  }

  // A mapper that has had the map from a second before now_us on.
  void begin(const OccupancyMap& map, std::int64_t now_us, std::int64_t map_id = 7) {
    bus::MapChange change;
    change.utime_us = now_us - 1'000'000;
    change.map_id = map_id;
    change.version = map.empty() ? 0 : 1;
    change.resolution = bus::resolution_of(map);
    change.blocks = bus::to_messages(map);
    mapper.emplace(std::move(change));
    publish(mapper->word());
    for (int i = -10; i < 0; ++i) run(now_us + i * 100'000);
  }

  // The room as it is seen x_m ahead.
  void send_cloud(std::int64_t utime_us, float x_m = 0.F) {
    Cloud cloud = room(utime_us);
    for (auto& point : cloud.points) point.x() -= x_m;
    bus.publish(bus::kCloud, bus::to_message(cloud, "base", 0));
  }

  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health{"localiser"};
  LocaliserService service;
  std::optional<test::StandInMapper> mapper;
  std::vector<localisation_t> localisations;
  std::vector<std::size_t> poses_when_told;
  std::vector<pose_t> poses;
  std::vector<uncertain_pose_t> covariances;
  std::vector<rigid_transform_t> map_odom;
  std::vector<map_request_t> requests;
};

OccupancyMap map_of_room() {
  OccupancyMap map;
  add_scan(room(0), Pose3::Identity(), 100.0, map);
  return map;
}

TEST(LocaliserService, AsksForAMapAgainAndAgainAndClaimsNoPoseWithoutOne) {
  Scene scene;
  scene.send_cloud(kStart_us);
  for (int i = 0; i <= 30; ++i) scene.run(kStart_us + i * 100'000);
  EXPECT_EQ(scene.requests.size(), 11u) << "at most four times a second";
  ASSERT_EQ(scene.localisations.size(), 1u);
  EXPECT_EQ(scene.localisations[0].state, localisation_t::STATE_LOST);
  EXPECT_TRUE(scene.poses.empty());
}

TEST(LocaliserService, AnEmptyMapIsBegunByTheFirstCloud) {
  Scene scene;
  scene.begin({}, kStart_us);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  ASSERT_EQ(scene.localisations.size(), 1u);
  EXPECT_EQ(scene.localisations[0].state, localisation_t::STATE_TRACKING);
  EXPECT_EQ(scene.localisations[0].map_id, 7);
  EXPECT_EQ(scene.localisations[0].map_version, 0);
  EXPECT_EQ(scene.poses.size(), 1u);
}

// The room with a floor, by a scanner in base's origin that is mounted like this.
Cloud room_on_floor(const Tilt& mount) {
  Cloud cloud = room(kStart_us);
  for (float x = -3.F; x < 3.F; x += 0.1F)
    for (float y = -2.F; y < 2.5F; y += 0.1F) cloud.points.emplace_back(x, y, 0.F);
  cloud = moved(to_level(mount).inverse(), cloud);
  cloud.origins.clear();
  return cloud;
}

TEST(LocaliserService, NamesAFloorThatIsOffInTheFirstScanAndClaimsNothing) {
  Scene scene;
  scene.begin({}, kStart_us);
  const Tilt mount{0.61, 0.0, 9.8 * kRadPerDeg};
  scene.bus.publish(bus::kCloud, bus::to_message(room_on_floor(mount), "base", 0));
  scene.run(kStart_us);
  EXPECT_NE(scene.health.message().find("floor tilted by 9.8 deg, 0.61 m low: is the mount set?"),
            std::string::npos)
      << scene.health.message();
  ASSERT_EQ(scene.localisations.size(), 1u);
  EXPECT_EQ(scene.localisations[0].state, localisation_t::STATE_LOST);
  EXPECT_TRUE(scene.poses.empty());
}

TEST(LocaliserService, TellsRollAndPitchOfACloudThatMayBeTilted) {
  LocaliserServiceConfig config;
  config.localiser.tilt = TiltUse::kRefine;
  Scene scene(config);
  scene.begin({}, kStart_us);
  const Tilt mount{0.61, 0.0, 9.8 * kRadPerDeg};
  scene.bus.publish(bus::kCloud, bus::to_message(room_on_floor(mount), "base", 0));
  scene.run(kStart_us);
  ASSERT_EQ(scene.poses.size(), 1u);
  EXPECT_NEAR(scene.poses[0].orientation[2], std::sin(mount.pitch_rad / 2.0), 0.002);
  EXPECT_NEAR(scene.localisations.at(0).modes.at(0).tilt[2], mount.pitch_rad, 0.005);
  EXPECT_EQ(scene.health.message().find("is the mount set"), std::string::npos);
}

TEST(LocaliserService, FindsACloudInTheMapThatItWasSent) {
  Scene scene;
  scene.begin(map_of_room(), kStart_us);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  ASSERT_EQ(scene.localisations.size(), 1u);
  const auto& found = scene.localisations[0];
  ASSERT_EQ(found.state, localisation_t::STATE_TRACKING);
  EXPECT_NEAR(found.modes.at(0).pose[0], 0.0, 0.03);
  EXPECT_NEAR(found.modes.at(0).pose[1], 0.0, 0.03);
  EXPECT_EQ(found.utime, kStart_us);
  EXPECT_GT(found.poses_examined, 0);
}

// HEALTH's counter of that name.
std::int64_t counted(Scene& scene, const std::string& name) {
  const health_t health = scene.health.last(kStart_us);
  for (const counter_t& counter : health.counters)
    if (counter.name == name) return counter.count;
  return 0;
}

TEST(LocaliserService, TakesHintsWhileItIsLostAndCountsTheOthers) {
  Scene scene;
  scene.begin(map_of_room(), kStart_us);
  pose_hint_t hint{};
  hint.utime = kStart_us;
  hint.sigma_m = 0.5;
  hint.sigma_rad = 0.3;
  scene.bus.publish(bus::kPoseHint, hint);
  pose_hint_t other = hint;
  other.map_id = 8;
  scene.bus.publish(bus::kPoseHint, other);
  other = hint;
  other.sigma_m = -1.0;
  scene.bus.publish(bus::kPoseHint, other);
  scene.run(kStart_us);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  ASSERT_EQ(scene.localisations.size(), 1u);
  ASSERT_EQ(scene.localisations[0].state, localisation_t::STATE_TRACKING);
  scene.bus.publish(bus::kPoseHint, hint);
  scene.run(kStart_us);
  EXPECT_EQ(counted(scene, "POSE_HINT/taken"), 1);
  EXPECT_EQ(counted(scene, "POSE_HINT/other_map"), 1);
  EXPECT_EQ(counted(scene, "POSE_HINT/not_a_pose"), 1);
  EXPECT_EQ(counted(scene, "POSE_HINT/refused"), 1);
}

TEST(LocaliserService, TheNextCloudWaitsForTheMappersWordButNotForEver) {
  Scene scene;
  scene.begin(map_of_room(), kStart_us);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  scene.send_cloud(kStart_us + 1'000'000);
  scene.run(kStart_us + 1'000'000);
  EXPECT_EQ(scene.localisations.size(), 1u);
  scene.mapper->map().utime_us = kStart_us;
  scene.publish(scene.mapper->word());
  scene.run(kStart_us + 1'000'001);
  EXPECT_EQ(scene.localisations.size(), 2u);

  scene.send_cloud(kStart_us + 2'000'000);
  scene.run(kStart_us + 2'000'000);
  EXPECT_EQ(scene.localisations.size(), 2u);
  scene.run(kStart_us + 2'600'000);
  EXPECT_EQ(scene.localisations.size(), 3u);
}

TEST(LocaliserService, PublishesPosesBetweenCloudsFromOdometry) {
  Scene scene;
  scene.begin(map_of_room(), kStart_us);
  scene.bus.publish(bus::kOdometry, bus::to_message(StampedPose2{kStart_us, {10.0, 5.0, 1.0}}));
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  scene.bus.publish(bus::kOdometry,
                    bus::to_message(StampedPose2{kStart_us + 100'000,
                                                 Pose2{10.0, 5.0, 1.0} * Pose2{0.05, 0.0, 0.0}}));
  scene.run(kStart_us + 100'000);
  ASSERT_EQ(scene.poses.size(), 2u);
  EXPECT_EQ(scene.poses[1].utime, kStart_us + 100'000);
  EXPECT_NEAR(scene.poses[1].pos[0], scene.poses[0].pos[0] + 0.05, 0.002);
  EXPECT_NEAR(scene.poses[1].vel[0], 0.5, 0.02);
}

TEST(LocaliserService, TellsHowSureEachPoseIs) {
  Scene scene;
  scene.begin(map_of_room(), kStart_us);
  const Pose2 T_odom_base{10.0, 5.0, 1.0};
  scene.bus.publish(bus::kOdometry, bus::to_message(StampedPose2{kStart_us, T_odom_base}));
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  for (int i = 1; i <= 3; ++i) {
    const Pose2 T_odom_now = T_odom_base * Pose2{0.2 * i, 0.0, 0.0};
    scene.bus.publish(bus::kOdometry,
                      bus::to_message(StampedPose2{kStart_us + i * 100'000, T_odom_now}));
    scene.run(kStart_us + i * 100'000);
  }
  ASSERT_EQ(scene.covariances.size(), 4u);
  ASSERT_EQ(scene.poses.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const uncertain_pose_t& told = scene.covariances[i];
    EXPECT_EQ(told.utime, scene.poses[i].utime);
    EXPECT_EQ(told.cloud_utime, kStart_us);
    EXPECT_EQ(told.map_id, 7);
    EXPECT_EQ(told.map_version, 1);
    EXPECT_EQ(told.pose[0], scene.poses[i].pos[0]);
    EXPECT_GT(told.covariance[0], i == 0 ? 0.0 : scene.covariances[i - 1].covariance[0]);
  }
  const pose_mode_t& mode = scene.localisations.at(0).modes.at(0);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(scene.covariances[0].covariance[i], mode.covariance[i]);
  EXPECT_LT(std::sqrt(scene.covariances[3].covariance[0]), 0.1) << "0.6 m by odometry";
}

TEST(LocaliserService, TellsTheTransformFromOdomToMapAtTrackedPosesAlone) {
  Scene scene;
  scene.begin(map_of_room(), kStart_us);
  const Pose2 T_odom_base{10.0, 5.0, 1.0};
  scene.bus.publish(bus::kOdometry, bus::to_message(StampedPose2{kStart_us, T_odom_base}));
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  ASSERT_EQ(scene.map_odom.size(), 1u);
  const rigid_transform_t& told = scene.map_odom[0];
  EXPECT_EQ(told.utime, kStart_us);
  const Pose3 T_map_odom =
      Eigen::Translation3d(Eigen::Vector3d(told.trans)) *
      Eigen::Quaterniond(told.quat[0], told.quat[1], told.quat[2], told.quat[3]);
  const auto pose = bus::from_message(scene.poses.at(0));
  ASSERT_TRUE(pose);
  EXPECT_TRUE((T_map_odom * to_pose3(T_odom_base)).isApprox(pose->pose, 1e-9));

  Cloud blind;
  blind.utime_us = kStart_us + 1'000'000;
  scene.bus.publish(bus::kCloud, bus::to_message(blind, "base", 0));
  scene.run(kStart_us + 1'600'000);
  scene.run(kStart_us + 2'200'000);
  ASSERT_EQ(scene.localisations.size(), 2u);
  EXPECT_EQ(scene.localisations[1].state, localisation_t::STATE_LOST);
  EXPECT_EQ(scene.map_odom.size(), 1u);
  EXPECT_EQ(scene.covariances.size(), 1u);
}

TEST(LocaliserService, ForgetsWhereItWasWhenTheMapIsAnother) {
  Scene scene;
  scene.begin(map_of_room(), kStart_us, 7);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  scene.begin(map_of_room(), kStart_us + 1'000'000, 8);
  scene.send_cloud(kStart_us + 1'000'000);
  scene.run(kStart_us + 1'000'000);
  ASSERT_EQ(scene.localisations.size(), 2u);
  EXPECT_EQ(scene.localisations[1].map_id, 8);
  EXPECT_TRUE(scene.localisations[1].searched_whole_map);
}

// The mapper's word on the first cloud is lost, and the robot drives on.
// Its loops were closed: the map turned and went 2 m aside, and the robot with it.
TEST(LocaliserService, AnnouncesPosesJumpBeforeItHappensWhereTheMapIsMoved) {
  Scene scene;
  const OccupancyMap before = map_of_room();
  scene.begin(before, kStart_us);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  ASSERT_EQ(scene.poses.size(), 1u);
  const Pose2 jump{2.0, -1.0, 0.3};
  OccupancyMap after;
  add_scan(room(0), to_pose3(jump), 100.0, after);
  bus::MapChange change = scene.mapper->map();
  change.utime_us = kStart_us;
  change.base_version = change.version++;
  change.moves = 1;
  change.T_new_old = jump;
  change.blocks = bus::to_messages(after, difference(before, after));
  scene.publish(bus::split_map(change));
  scene.mapper->map().version = change.version;
  scene.mapper->map().moves = change.moves;
  scene.run(kStart_us + 1);
  EXPECT_EQ(scene.poses.size(), 1u);
  for (int second = 1; second < 3; ++second) {
    scene.send_cloud(kStart_us + second * 1'000'000);
    scene.mapper->map().utime_us = kStart_us + second * 1'000'000;
    scene.run(kStart_us + second * 1'000'000);
    scene.publish(scene.mapper->word());
  }
  ASSERT_EQ(scene.localisations.size(), 3u);
  const localisation_t& told = scene.localisations[1];
  EXPECT_EQ(told.state, localisation_t::STATE_TRACKING);
  EXPECT_EQ(told.searched_whole_map, 0) << "it knows where it is";
  EXPECT_EQ(told.jump[0], jump.x_m);
  EXPECT_EQ(told.jump[1], jump.y_m);
  EXPECT_EQ(told.jump[2], jump.yaw_rad);
  EXPECT_NEAR(told.modes[0].pose[0], jump.x_m, 0.01);
  EXPECT_NEAR(told.modes[0].pose[1], jump.y_m, 0.01);
  EXPECT_EQ(scene.localisations[2].jump[0], 0.0);
  EXPECT_EQ(scene.poses_when_told[1], 1u);
  EXPECT_LT(std::hypot(scene.poses[1].vel[0], scene.poses[1].vel[1]), 0.05) << "the robot stood";
}

TEST(LocaliserService, OneCloudAloneIsTheOriginOfAMap) {
  Scene scene;
  scene.begin({}, kStart_us);
  for (int i = 0; i < 10; ++i) {
    const std::int64_t now_us = kStart_us + i * 1'000'000;
    scene.send_cloud(now_us, 0.1F * static_cast<float>(i));
    scene.run(now_us);
    scene.run(now_us + 600'000);
    ASSERT_EQ(scene.localisations.size(), static_cast<std::size_t>(i + 1));
    const localisation_t& found = scene.localisations.back();
    ASSERT_EQ(found.state, localisation_t::STATE_TRACKING) << i;
    EXPECT_NEAR(found.modes[0].pose[0], 0.1 * i, 0.05);
    EXPECT_EQ(found.map_version, 0);
  }
}

TEST(LocaliserService, GoesOnInTheMappersMapWhenItsFirstWordWasLost) {
  Scene scene;
  scene.begin({}, kStart_us);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  OccupancyMap map;
  add_scan(room(0), Pose3::Identity(), 100.0, map);
  bus::MapChange& held = scene.mapper->map();
  held.version = 1;
  held.utime_us = kStart_us;
  held.blocks = bus::to_messages(map);
  for (int i = 1; i < 4; ++i) {
    const std::int64_t now_us = kStart_us + i * 1'000'000;
    scene.send_cloud(now_us, 0.1F * static_cast<float>(i));
    scene.run(now_us);
    scene.run(now_us + 600'000);
    scene.run(now_us + 700'000);
  }
  const localisation_t& found = scene.localisations.back();
  EXPECT_EQ(found.map_version, 1);
  EXPECT_EQ(found.state, localisation_t::STATE_TRACKING);
  EXPECT_NEAR(found.modes[0].pose[0], 0.3, 0.03);
}

// The mapper is asked for a new map, and has none.
TEST(LocaliserService, SetsNoSecondOriginWhereNothingFitsTheFirst) {
  Scene scene;
  scene.begin({}, kStart_us);
  Cloud lid;
  lid.utime_us = kStart_us;
  for (int i = 0; i < 300; ++i) lid.points.emplace_back(0.2F, 0.001F * static_cast<float>(i), 0.5F);
  scene.bus.publish(bus::kCloud, bus::to_message(lid, "base", 0));
  scene.run(kStart_us);
  for (int i = 1; i < 20; ++i) {
    scene.send_cloud(kStart_us + i * 3'000'000);
    scene.run(kStart_us + i * 3'000'000);
    scene.run(kStart_us + i * 3'000'000 + 600'000);
    scene.run(kStart_us + i * 3'000'000 + 2'900'000);
  }
  ASSERT_EQ(scene.localisations.size(), 20u);
  for (std::size_t i = 1; i < 20; ++i)
    EXPECT_NE(scene.localisations[i].state, localisation_t::STATE_TRACKING) << i;
  EXPECT_EQ(scene.localisations[0].state, localisation_t::STATE_TRACKING);
}

// An answer waits for the next cloud, but not for ever; two that fit each other ask for a new map.
TEST(LocaliserService, AsksForANewMapWhereTwoCloudsFitEachOtherAndNotTheFirst) {
  Scene scene;
  scene.begin({}, kStart_us);
  Cloud lid;
  lid.utime_us = kStart_us;
  for (int i = 0; i < 300; ++i) lid.points.emplace_back(0.2F, 0.001F * static_cast<float>(i), 0.5F);
  scene.bus.publish(bus::kCloud, bus::to_message(lid, "base", 0));
  scene.run(kStart_us);
  const auto asked = [&] {
    return std::ranges::count(scene.requests, int{map_request_t::WANT_NEW_MAP},
                              &map_request_t::want);
  };
  scene.send_cloud(kStart_us + 1'000'000);
  scene.run(kStart_us + 1'000'000);
  scene.run(kStart_us + 1'600'000);  // no mapper has the lid
  EXPECT_EQ(scene.localisations.size(), 1u);
  EXPECT_EQ(asked(), 0);
  scene.send_cloud(kStart_us + 2'000'000, 0.1F);
  scene.run(kStart_us + 2'000'000);
  EXPECT_EQ(asked(), 1);
  scene.run(kStart_us + 3'900'000);
  EXPECT_EQ(scene.localisations.size(), 1u);
  scene.run(kStart_us + 4'100'000);
  ASSERT_EQ(scene.localisations.size(), 3u);
  for (std::size_t i = 1; i < 3; ++i)
    EXPECT_NE(scene.localisations[i].state, localisation_t::STATE_TRACKING) << i;
}

TEST(LocaliserService, ACloudThatTellsNothingIsNoOrigin) {
  Scene scene;
  scene.begin({}, kStart_us);
  Cloud far;
  far.utime_us = kStart_us;
  for (int i = 0; i < 300; ++i) far.points.emplace_back(200.F, 0.1F * static_cast<float>(i), 0.5F);
  scene.bus.publish(bus::kCloud, bus::to_message(far, "base", 0));
  scene.run(kStart_us);
  EXPECT_EQ(scene.localisations.at(0).state, localisation_t::STATE_LOST);
  scene.send_cloud(kStart_us + 1'000'000);
  scene.run(kStart_us + 1'000'000);
  EXPECT_EQ(scene.localisations.at(1).state, localisation_t::STATE_TRACKING);
}

TEST(LocaliserService, ClaimsNoPoseInAForgedMap) {
  Scene scene;
  scene.begin(map_of_room(), kStart_us);
  for (const std::int64_t map_id : {7, 8}) {
    for (const std::int64_t version : {0, 1, 2, 99}) {
      bus::MapChange forged;
      forged.utime_us = kStart_us + 1;
      forged.map_id = map_id;
      forged.version = version;
      forged.resolution = bus::resolution_of({});
      scene.publish(bus::split_map(forged));
    }
  }
  scene.send_cloud(kStart_us, 0.5F);
  scene.run(kStart_us);
  ASSERT_EQ(scene.localisations.size(), 1u);
  ASSERT_EQ(scene.localisations[0].state, localisation_t::STATE_TRACKING);
  EXPECT_EQ(scene.localisations[0].map_version, 1);
  EXPECT_NEAR(scene.localisations[0].modes[0].pose[0], 0.5, 0.03);
}

TEST(LocaliserService, AnEmptyMapThatTheMapperDoesNotCallEmptyHasNoOrigin) {
  Scene scene;
  scene.begin({}, kStart_us - 2'000'000);
  scene.mapper->map().version = 3;
  scene.publish(scene.mapper->word());
  for (int i = -10; i < 0; ++i) scene.run(kStart_us + i * 100'000);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  ASSERT_EQ(scene.localisations.size(), 1u);
  EXPECT_EQ(scene.localisations[0].state, localisation_t::STATE_LOST);
}

TEST(LocaliserService, AForgedTimeDoesNotShutOutTheCloudsAfterIt) {
  Scene scene;
  scene.begin(map_of_room(), kStart_us);
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  scene.send_cloud(kStart_us + 30'000'000);
  scene.run(kStart_us + 1'000'000);
  for (int i = 2; i < 10; ++i) {
    scene.send_cloud(kStart_us + i * 1'000'000);
    scene.run(kStart_us + i * 1'000'000);
    scene.run(kStart_us + i * 1'000'000 + 600'000);  // no mapper answers: it waits for 0.5 s
  }
  EXPECT_EQ(scene.localisations.size(), 2u + 8u - 2u);
  EXPECT_EQ(scene.localisations.back().utime, kStart_us + 9'000'000);
}

TEST(LocaliserService, TellsThatOdometryIsOfAnotherTime) {
  Scene scene;
  scene.begin(map_of_room(), kStart_us);
  const std::int64_t old_us = kStart_us - 12'000'000;
  scene.bus.publish(bus::kOdometry, bus::to_message(StampedPose2{old_us, {}}));
  scene.send_cloud(kStart_us);
  scene.run(kStart_us);
  EXPECT_EQ(scene.health.message(),
            "ODOMETRY is 12.0 s older than CLOUD and is not used: do their clocks agree?");
  scene.bus.publish(bus::kOdometry, bus::to_message(StampedPose2{kStart_us + 1'000'000, {}}));
  scene.send_cloud(kStart_us + 1'000'000);
  scene.run(kStart_us + 1'000'000);
  scene.run(kStart_us + 6'000'000);
  EXPECT_EQ(scene.health.message().find("older"), std::string::npos) << scene.health.message();
}

TEST(LocaliserService, TellsThatOdometryDisagreesWithTheScansUntilItAgreesAgain) {
  Scene scene;
  scene.begin(map_of_room(), kStart_us);
  double by_odometry_m = 0.0;
  std::vector<std::string> told;
  for (int i = 0; i < 24; ++i) {
    const std::int64_t now_us = kStart_us + i * 1'000'000;
    by_odometry_m += i == 3 ? 0.35 : 0.02;
    scene.bus.publish(bus::kOdometry,
                      bus::to_message(StampedPose2{now_us, {by_odometry_m, 0.0, 0.0}}));
    scene.send_cloud(now_us, 0.02F * static_cast<float>(i));
    scene.run(now_us);
    scene.run(now_us + 600'000);  // no mapper answers: it waits for 0.5 s
    ASSERT_EQ(scene.localisations.back().state, localisation_t::STATE_TRACKING) << i;
    EXPECT_NEAR(scene.localisations.back().modes[0].pose[0], 0.02 * i, 0.02) << i;
    told.push_back(scene.health.message());
  }
  EXPECT_EQ(told[3].find("disagrees"), std::string::npos) << told[3];
  EXPECT_NE(told[4].find("ODOMETRY disagrees with the scans, which are believed: over 0.3"),
            std::string::npos)
      << told[4];
  EXPECT_NE(told[4].find("s it is off by 0.33 m and 0."), std::string::npos) << told[4];
  EXPECT_EQ(told[23].find("disagrees"), std::string::npos) << told[23];
}

TEST(LocaliserService, TellsWhatOdometryIsOffByAllTheTime) {
  Scene scene;
  scene.begin(map_of_room(), kStart_us);
  for (int i = 0; i < 8; ++i) {
    const std::int64_t now_us = kStart_us + i * 1'000'000;
    scene.bus.publish(bus::kOdometry, bus::to_message(StampedPose2{now_us, {0.33 * i, 0.0, 0.0}}));
    scene.send_cloud(now_us, 0.3F * static_cast<float>(i));
    scene.run(now_us);
    scene.run(now_us + 600'000);  // no mapper answers: it waits for 0.5 s
  }
  const health_t health = scene.health.last(kStart_us);
  const auto gauge = [&](const std::string& name) {
    const auto found = std::ranges::find(health.gauges, name, &gauge_t::name);
    return found == health.gauges.end() ? 1e9 : found->value;
  };
  const double sigma = gauge("odometry_scale_sigma_percent");
  EXPECT_LT(sigma, 4.0);
  EXPECT_NEAR(gauge("odometry_scale_percent"), -9.1, 3.0 * sigma);
  EXPECT_LT(gauge("odometry_scale_percent"), -2.0);
  EXPECT_NEAR(gauge("odometry_heading_deg"), 0.0, 3.0 * gauge("odometry_heading_sigma_deg"));
}

TEST(LocaliserService, TellsThatOdometryIsNoPose) {
  Scene scene;
  pose_t message{};
  message.utime = kStart_us;
  scene.bus.publish(bus::kOdometry, message);
  scene.run(kStart_us);
  EXPECT_NE(scene.health.message().find("ODOMETRY is no pose"), std::string::npos);
}

}  // namespace
}  // namespace voxlist::services
