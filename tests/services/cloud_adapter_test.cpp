#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/cloud_adapter/cloud_adapter_service.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"

namespace voxlist::services {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kSecond_us = 1'000'000;
constexpr std::int64_t kStart_us = 1'700'000'000 * kSecond_us;

// One laser that tells its points' times.
adapter::AdapterConfig one_laser() {
  adapter::AdapterConfig config;
  config.sensors.emplace_back().channel = "LASER_3D";
  config.sensors[0].mount_z_m = 1.0;
  config.sensors[0].time_channel = "time";
  return config;
}

// A wall ahead, seen over 0.1 s.
pointcloud_t sweep(std::int64_t utime_us, const std::string& times = "time") {
  pointcloud_t message{};
  message.utime = utime_us;
  message.n_points = 100;
  message.n_channels = 1;
  message.channel_names = {times};
  message.channels.resize(1);
  for (int i = 0; i < message.n_points; ++i) {
    message.points.push_back({5.0F, static_cast<float>(i) * 0.1F - 5.0F, 0.0F});
    message.channels[0].push_back(static_cast<float>(i) * 0.1F / 99.0F);
  }
  return message;
}

// The service, a test that plays laser and base, and what others hear.
struct Scene {
  explicit Scene(const adapter::AdapterConfig& config = one_laser())
      : service(bus, health, config) {
    bus.subscribe(bus::kCloud, [this](const pointcloud_t& m) { clouds.push_back(m); });
    bus.subscribe(bus::kCloudSlice, [this](const pointcloud_t& m) { slices.push_back(m); });
    service.tick(now_us);
  }

  void laser(const pointcloud_t& message, const char* channel = "LASER_3D") {
    bus.publish(bus::Channel<pointcloud_t>{channel}, message);
    hear();
  }
  // Straight ahead at 1 m/s; each time once.
  void odometry(std::int64_t utime_us) {
    if (utime_us == odometry_us) return;
    odometry_us = utime_us;
    const double x_m = static_cast<double>(utime_us - kStart_us) * 1e-6;
    bus.publish(bus::kOdometry, bus::to_message(StampedPose2{utime_us, {x_m, 0.0, 0.0}}));
    hear();
  }

  // So many sweeps, odometry at 50 Hz.
  void play(int sweeps, bool with_odometry = true) {
    for (int i = 0; i < sweeps; ++i) {
      const std::int64_t start_us = now_us;
      for (int step = 0; step <= 5; ++step) {
        now_us = start_us + step * 20'000;
        if (with_odometry) odometry(now_us);
        service.tick(now_us);
      }
      laser(sweep(start_us));
    }
  }

  void hear() {
    for (int i = 0; i < 3; ++i) bus.handle(std::chrono::milliseconds(0));
  }

  health_t told() { return health.due(health_us += 2 * kSecond_us).value(); }

  std::int64_t counted(const std::string& name) {
    for (const counter_t& counter : told().counters)
      if (counter.name == name) return counter.count;
    return 0;
  }

  bus::Bus bus{{.url = "memq://", .prefix = ""}};
  bus::Health health{"cloud_adapter"};
  CloudAdapterService service;
  std::int64_t now_us = kStart_us, health_us = 0, odometry_us = 0;
  std::vector<pointcloud_t> clouds, slices;
};

TEST(CloudAdapterService, PublishesACloudInBaseOfEachSweep) {
  Scene scene;
  scene.play(5);
  ASSERT_EQ(scene.clouds.size(), 5u);
  const pointcloud_t& cloud = scene.clouds[2];
  EXPECT_EQ(cloud.frame_id, "base");
  EXPECT_EQ(cloud.seq, 2);
  EXPECT_EQ(cloud.utime, kStart_us + 300'000) << "its last point's time";
  ASSERT_EQ(cloud.n_points, 100);
  EXPECT_NEAR(cloud.points[0][0], 4.9F, 1e-4F) << "the robot drove 0.1 m since";
  EXPECT_NEAR(cloud.points[99][0], 5.0F, 1e-4F);
  EXPECT_FLOAT_EQ(cloud.points[50][2], 1.0F);
  ASSERT_EQ(cloud.n_channels, 3);
  EXPECT_FLOAT_EQ(cloud.channels[2][0], 1.0F) << "rays start at the laser";
  EXPECT_EQ(scene.counted("LASER_3D/used"), 5);
  EXPECT_EQ(scene.counted("LASER_3D/points/points"), 500);
  EXPECT_EQ(scene.told().state, health_t::STATE_OK) << scene.told().message;
}

TEST(CloudAdapterService, TellsHowLongACloudTook) {
  Scene scene;
  scene.play(2);
  scene.service.tick(kStart_us * 2);
  EXPECT_GE(scene.told().latency_max_ms, 0.0F);
}

TEST(CloudAdapterService, SaysWhoIsSilent) {
  Scene scene;
  for (int i = 0; i < 50; ++i) scene.service.tick(scene.now_us += 100'000);
  const std::string told = scene.told().message;
  EXPECT_THAT(told, HasSubstr("no LASER_3D yet: is its driver running?"));
  EXPECT_THAT(told, HasSubstr("no ODOMETRY yet: is the robot base running?"));
  scene.play(60);
  EXPECT_EQ(scene.told().message, "");
}

TEST(CloudAdapterService, SaysThatSweepsWaitForOdometryInVain) {
  Scene scene;
  scene.play(10, false);
  EXPECT_TRUE(scene.clouds.empty());
  EXPECT_GT(scene.counted("LASER_3D/no_odometry"), 3);
  const health_t told = scene.told();
  EXPECT_EQ(told.state, health_t::STATE_ERROR);
  EXPECT_THAT(told.message, HasSubstr("LASER_3D waits for ODOMETRY in vain"));
}

TEST(CloudAdapterService, DoesNotMissOdometryThatItDoesNotUse) {
  adapter::AdapterConfig config = one_laser();
  config.use_odometry = false;
  Scene scene(config);
  scene.play(40, false);
  EXPECT_EQ(scene.clouds.size(), 40u);
  EXPECT_EQ(scene.told().message, "");
}

TEST(CloudAdapterService, SaysWhichChannelsThereAreWhereTheTimesAreNot) {
  Scene scene;
  scene.laser(sweep(kStart_us, "t"));
  EXPECT_THAT(scene.told().message, HasSubstr("LASER_3D has no channel \"time\" (time_channel); "
                                              "it has: t"));
  EXPECT_EQ(scene.counted("LASER_3D/no_time_channel"), 1);
}

TEST(CloudAdapterService, SaysWhatIsWrongWithThePointsTimes) {
  Scene scene;
  pointcloud_t message = sweep(kStart_us);
  for (float& time : message.channels[0]) time *= 1e9F;  // nanoseconds
  scene.laser(message);
  EXPECT_THAT(scene.told().message, HasSubstr("is time_unit right?"));
  EXPECT_EQ(scene.counted("LASER_3D/bad_point_times"), 1);
}

TEST(CloudAdapterService, SaysWhereAllPointsWent) {
  adapter::AdapterConfig config = one_laser();
  config.robot_boxes_m = {-10.0, 10.0, -10.0, 10.0, 0.0, 2.0};
  Scene scene(config);
  scene.play(2);
  EXPECT_TRUE(scene.clouds.empty());
  EXPECT_THAT(scene.told().message, HasSubstr("100 on the robot (robot_boxes_m)"));
  EXPECT_THAT(scene.told().message, HasSubstr("robot_boxes_m hold 100 % of LASER_3D's points"));
}

TEST(CloudAdapterService, JoinsTwoLasersAndSaysWhenOneIsMissing) {
  adapter::AdapterConfig config;
  config.use_odometry = false;
  for (const char* channel : {"FRONT", "BACK"}) config.sensors.emplace_back().channel = channel;
  config.sensors[1].mount_yaw_deg = 180.0;
  Scene scene(config);
  scene.laser(sweep(kStart_us), "FRONT");
  EXPECT_TRUE(scene.clouds.empty());
  scene.laser(sweep(kStart_us + 30'000), "BACK");
  ASSERT_EQ(scene.clouds.size(), 1u);
  EXPECT_EQ(scene.clouds[0].n_points, 200);
  EXPECT_FLOAT_EQ(scene.clouds[0].points[150][0], -5.0F);
  for (int i = 1; i < 5; ++i) scene.laser(sweep(kStart_us + i * 100'000), "FRONT");
  EXPECT_GE(scene.clouds.size(), 3u);
  EXPECT_THAT(scene.told().message, HasSubstr("CLOUD goes out without some of the sensors"));
  EXPECT_GE(scene.counted("CLOUD/incomplete"), 2);
}

TEST(CloudAdapterService, TakesTheNewestThatWaitsAndSaysHowManyItLeftOut) {
  Scene scene;
  scene.play(2);
  for (int i = 0; i < 3; ++i)
    scene.bus.publish(bus::Channel<pointcloud_t>{"LASER_3D"}, sweep(scene.now_us + i * 10'000));
  scene.odometry(scene.now_us + 120'000);
  ASSERT_EQ(scene.clouds.size(), 3u);
  EXPECT_EQ(scene.clouds[2].utime, scene.now_us + 120'000) << "that of the newest";
  scene.service.tick(scene.now_us += 120'000);
  const health_t told = scene.told();
  EXPECT_THAT(told.message, HasSubstr("2 of LASER_3D left out for newer ones"));
  EXPECT_EQ(told.state, health_t::STATE_WARNING);
}

TEST(CloudAdapterService, SaysThatMessagesWereLostOnTheirWay) {
  Scene scene;
  for (const int seq : {1, 2, 5}) {
    pointcloud_t message = sweep(kStart_us + seq * 100'000);
    message.seq = seq;
    scene.laser(message);
  }
  EXPECT_THAT(scene.told().message, HasSubstr("LASER_3D has gaps in seq: 2 of 4 lost"));
}

TEST(CloudAdapterService, SaysThatALaserIsFasterThanItMayBeAsNoFault) {
  adapter::AdapterConfig config = one_laser();
  config.max_rate_hz = 3.0;
  Scene scene(config);
  scene.play(20);
  const health_t told = scene.told();
  EXPECT_THAT(told.message, HasSubstr("LASER_3D comes faster than CLOUD may (max_rate_hz)"));
  EXPECT_EQ(told.state, health_t::STATE_OK);
}

TEST(CloudAdapterService, PublishesSlicesWhenAskedTo) {
  adapter::AdapterConfig config = one_laser();
  config.slices = true;
  Scene scene(config);
  scene.play(3);
  EXPECT_EQ(scene.slices.size(), 3u);
  EXPECT_EQ(scene.clouds.size(), 3u);
  EXPECT_EQ(scene.slices[2].seq, 2);
}

TEST(CloudAdapterService, LosesOnlyWhatIsForged) {
  Scene scene;
  scene.play(3);
  pointcloud_t forged = sweep(scene.now_us + 10);
  constexpr float kInf = std::numeric_limits<float>::infinity();
  forged.points[0] = {NAN, kInf, 3e38F};
  forged.channels[0][1] = kInf;
  forged.channels[0][2] = NAN;
  scene.odometry(scene.now_us + 120'000);
  scene.laser(forged);
  ASSERT_EQ(scene.clouds.size(), 4u);
  EXPECT_EQ(scene.clouds[3].n_points, 97);

  std::vector<std::uint8_t> bytes;
  ASSERT_EQ(bus::encode(sweep(kStart_us), bytes), bus::Fault::kNone);
  bytes[20 + 4 + 1] = 0x7F;  // of the number of points
  scene.bus.publish_encoded("LASER_3D", bytes);
  scene.hear();
  EXPECT_EQ(scene.counted("LASER_3D/points/no_return"), 1);
  EXPECT_EQ(scene.counted("LASER_3D/points/no_time"), 2);
  for (pointcloud_t& wrong : std::vector<pointcloud_t>{sweep(-1), sweep(kStart_us * 1000)})
    scene.laser(wrong);
  EXPECT_EQ(scene.counted("LASER_3D/bad_utime"), 2);
  EXPECT_EQ(scene.clouds.size(), 4u);
  scene.now_us += 200'000;
  scene.play(2);
  EXPECT_EQ(scene.clouds.size(), 6u);
}

TEST(CloudAdapterService, DoesNotStartWithSettingsThatDoNotFitTogether) {
  EXPECT_THROW(Scene{adapter::AdapterConfig{}}, std::invalid_argument);
  adapter::AdapterConfig config = one_laser();
  config.sensors[0].channel = "LASER 3D";
  EXPECT_THROW(CloudAdapterService::check(config), std::invalid_argument);
  EXPECT_NO_THROW(CloudAdapterService::check(one_laser()));
}

}  // namespace
}  // namespace voxlist::services
