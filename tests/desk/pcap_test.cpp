// Recordings of a Velodyne laser's network, through the desk tool.
#include <gmock/gmock.h>

#include <cmath>
#include <voxlist/pointcloud_t.hpp>

#include "tests/desk/scan_set.h"
#include "tests/io/packets/capture.h"
#include "tests/scanner/velodyne/velodyne_encoder.h"
#include "voxlist/bus/event_log.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

// A room of 8 x 6 m round a VLP-16, in units of 2 mm.
std::pair<int, int> room(int azimuth_cdeg, int i) {
  constexpr double kElevations_deg[] = {-15, 1, -13, 3,  -11, 5,  -9, 7,
                                        -7,  9, -5,  11, -3,  13, -1, 15};
  const double azimuth = azimuth_cdeg * 0.01 * M_PI / 180.0;
  const double across =
      std::max(std::abs(std::cos(azimuth)) / 4.0, std::abs(std::sin(azimuth)) / 3.0);
  const double range_m = 1.0 / across / std::cos(kElevations_deg[i % 16] * M_PI / 180.0);
  return {static_cast<int>(range_m * 500.0), i};
}

class Pcap : public testing::Test {
 protected:
  void say(int packets) {
    for (int n = 0; n < packets; ++n) {
      const int azimuth_cdeg = laser_.azimuth_cdeg;
      after_us_ += laser_.packet_us();
      capture_.udp(now_us(), laser_.packet([&](int block, int i) {
        return room(azimuth_cdeg + block * 40, i);
      }));
    }
  }
  std::int64_t now_us() const { return kStart_us + static_cast<std::int64_t>(after_us_); }

  test::DeskRun import() {
    capture_.write(file_);
    return test::run({"import", file_, "-o", log_, "--channel", "VELODYNE"});
  }

  std::vector<pointcloud_t> imported() const {
    std::vector<pointcloud_t> clouds;
    bus::EventLogReader log(log_);
    while (const auto event = log.next()) {
      EXPECT_EQ(event->channel, "VELODYNE");
      EXPECT_EQ(bus::decode(event->bytes, clouds.emplace_back()), bus::Fault::kNone);
    }
    return clouds;
  }

  scanner::test::VelodyneEncoder laser_;
  io::test::Capture capture_;
  double after_us_ = 0.0;
  test::WorkFolder work_;
  const std::string file_ = work_ / "drive.pcap", log_ = work_ / "raw.lcm";
};

TEST_F(Pcap, BecomesALogOfSweepsWithTheTimeOfEachPoint) {
  say(240);
  const test::DeskRun run = import();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  const auto clouds = imported();
  ASSERT_EQ(clouds.size(), 4u);
  EXPECT_EQ(clouds[1].n_points, 28'800);
  EXPECT_THAT(clouds[1].channel_names, testing::ElementsAre("intensity", "ring", "time"));
  EXPECT_NEAR(clouds[1].channels[2].back(), 0.0995F, 1e-3F);
  EXPECT_NEAR(clouds[1].points.front()[0], -4.0F, 0.01F);
}

TEST_F(Pcap, MapsWithTheRobotsSettings) {
  say(240);
  capture_.write(file_);
  test::write_text(work_ / "robot.toml",
                   "[cloud_adapter]\nuse_odometry = false\n[[cloud_adapter.sensor]]\n"
                   "channel = \"VELODYNE\"\nmount_z_m = 1.0\ntime_channel = \"time\"\n");
  const test::DeskRun run = test::run(
      {"map", file_, "-o", work_ / "map", "--no-octomap", "--config", work_ / "robot.toml"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("scans placed"));
}

TEST_F(Pcap, SaysWhatIsTornForeignOrCutAndLosesNothingElse) {
  say(60);
  auto torn = laser_.packet([](int, int) { return std::pair{500, 1}; });
  torn[400] = 0;
  capture_.udp(now_us(), torn);
  capture_.udp(now_us(), std::vector<std::uint8_t>(512), 8308);
  capture_.udp(now_us(), std::vector<std::uint8_t>(64), 53, 1);
  scanner::test::VelodyneEncoder second;
  capture_.udp(now_us(), second.packet([](int, int) { return std::pair{500, 1}; }), 2368, 202);
  say(60);
  capture_.frame(now_us(), std::vector<std::uint8_t>(30));
  say(1);
  capture_.write(file_);
  std::string bytes = test::read_text(file_);
  test::write_text(file_, bytes.substr(0, bytes.size() - 100));
  const test::DeskRun run = test::run({"import", file_, "-o", log_, "--channel", "VELODYNE"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* told :
       {"1 broken_packets", "1 of_another_laser", "1 packets of the laser are missing",
        "1 packets of 512 B to port 8308", "1 packets of 64 B to port 53", "ends in the middle"})
    EXPECT_THAT(run.err, HasSubstr(told));
  std::size_t points = 0;
  for (const pointcloud_t& cloud : imported()) points += cloud.points.size();
  EXPECT_EQ(points, 120u * 384u);
}

TEST_F(Pcap, SaysWhatItHasWhereThereIsNoLaser) {
  capture_.udp(kStart_us, std::vector<std::uint8_t>(100), 53);
  const test::DeskRun run = import();
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("no data packet of a Velodyne VLP-16 or HDL-32E; it has 1 packets "
                                 "of 100 B to port 53"));
}

TEST_F(Pcap, SaysThatItNeedsAChannel) {
  say(1);
  capture_.write(file_);
  const test::DeskRun run = test::run({"import", file_, "-o", log_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("name a channel for them (import --channel)"));
}

}  // namespace
}  // namespace voxlist::desk
