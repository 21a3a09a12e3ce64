#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <stdexcept>
#include <vector>
#include <voxlist/health_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "services/scan_source/scan_source_service.h"
#include "tests/temporary_folder.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/io/clouds/cloud_file.h"

namespace voxlist::services {
namespace {

using test::TemporaryFolder;

constexpr std::int64_t kStart_us = 1'700'000'000'000'000;
constexpr std::int64_t kSecond_us = 1'000'000;

// Three scans of one point each, at x = 0, 1, 2.
class ScanSource : public testing::Test {
 protected:
  ScanSource() {
    config_.folder = folder_.string();
    for (int i = 0; i < 3; ++i) {
      Cloud cloud;
      cloud.points.emplace_back(static_cast<float>(i), 0.0F, 0.5F);
      cloud.origins.emplace_back(0.0F, 0.0F, 0.25F);
      io::write_ply(scan(i), cloud);
    }
    bus_.subscribe(bus::kCloud, [this](const pointcloud_t& m) {
      clouds_.push_back(m);
      odometry_before_cloud_.push_back(odometry_.size());
    });
    bus_.subscribe(bus::kOdometry, [this](const pose_t& m) { odometry_.push_back(m); });
    bus_.subscribe(bus::kTruth, [this](const pose_t& m) { truth_.push_back(m); });
  }

  std::filesystem::path scan(int i) const {
    return folder_ / ("scan_" + std::to_string(i) + ".ply");
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  void start() { source_.emplace(bus_, health_, config_); }

  // Ticks often until `seconds` after the start.
  void run_to(double seconds) {
    for (; now_us_ <= static_cast<std::int64_t>(seconds * 1e6); now_us_ += 10'000) {
      source_->tick(kStart_us + now_us_);
      bus_.handle(std::chrono::milliseconds(0));
    }
  }

  TemporaryFolder folder_;
  ScanSourceConfig config_;
  bus::Bus bus_{{.url = "memq://", .prefix = ""}};
  bus::Health health_{"scan_source"};
  std::optional<ScanSourceService> source_;
  std::int64_t now_us_ = 0;
  std::vector<pointcloud_t> clouds_;
  std::vector<pose_t> odometry_, truth_;
  std::vector<std::size_t> odometry_before_cloud_;
};

TEST_F(ScanSource, PublishesScansAtTheirOwnTimes) {
  write("poses.csv", "index,t_s,x,y,yaw\n0,100.0,0,0,0\n1,100.5,1,0,0\n2,103.0,2,0,0\n");
  start();
  run_to(0.4);
  ASSERT_EQ(clouds_.size(), 1u);
  EXPECT_EQ(clouds_[0].utime, 100 * kSecond_us);
  run_to(2.9);
  ASSERT_EQ(clouds_.size(), 2u);
  EXPECT_EQ(clouds_[1].utime, 100 * kSecond_us + kSecond_us / 2);
  run_to(3.1);
  ASSERT_EQ(clouds_.size(), 3u);
  EXPECT_EQ(clouds_[2].utime, 103 * kSecond_us);
}

TEST_F(ScanSource, PublishesWhatIsInTheFiles) {
  start();
  run_to(2.0);
  ASSERT_EQ(clouds_.size(), 3u);
  for (std::int32_t i = 0; i < 3; ++i) {
    const pointcloud_t& message = clouds_[static_cast<std::size_t>(i)];
    EXPECT_EQ(message.seq, i);
    EXPECT_EQ(message.frame_id, "base");
    const bus::ReceivedCloud received = bus::from_message(message);
    ASSERT_TRUE(received.cloud);
    ASSERT_EQ(received.cloud->points.size(), 1u);
    EXPECT_EQ(received.cloud->points[0].x(), static_cast<float>(i));
    EXPECT_EQ(received.cloud->origin(0).z(), 0.25F);
  }
}

TEST_F(ScanSource, RunsAsFastAsItIsTold) {
  config_.speed = 10.0;
  start();
  run_to(0.15);
  EXPECT_EQ(clouds_.size(), 2u);
}

TEST_F(ScanSource, PublishesOneScanATickHoweverLateItIs) {
  start();
  source_->tick(kStart_us);
  source_->tick(kStart_us + 60 * kSecond_us);
  bus_.handle(std::chrono::milliseconds(0));
  EXPECT_EQ(clouds_.size(), 2u);
}

TEST_F(ScanSource, PublishesOdometryAndTruthWhereTheFolderHasThem) {
  write("poses.csv", "index,t_s,x,y,yaw\n0,7,0.5,0,0\n2,9,2.5,0,0\n");
  write("odometry.csv", "t,x,y,yaw\n7,0,0,0\n7.4,0.1,0,0\n8,0.2,0,0\n9,0.3,0,0\n");
  start();
  run_to(1.5);
  ASSERT_EQ(odometry_.size(), 3u);
  EXPECT_EQ(odometry_[1].utime, 7'400'000);
  EXPECT_DOUBLE_EQ(odometry_[1].pos[0], 0.1);
  EXPECT_EQ(clouds_.size(), 2u);
  run_to(3.0);
  ASSERT_EQ(truth_.size(), 2u) << "poses.csv has no line for the second scan";
  EXPECT_EQ(truth_[1].utime, clouds_[2].utime);
  EXPECT_DOUBLE_EQ(truth_[1].pos[0], 2.5);
}

TEST_F(ScanSource, PublishesOdometryBeforeTheScanOfTheSameTime) {
  write("odometry.csv", "t,x,y,yaw\n0,0,0,0\n1,0.1,0,0\n2,0.2,0,0\n");
  start();
  run_to(3.0);
  EXPECT_EQ(odometry_before_cloud_, (std::vector<std::size_t>{1, 2, 3}));
}

TEST_F(ScanSource, GoesOnPastADamagedFile) {
  std::filesystem::resize_file(scan(1), std::filesystem::file_size(scan(1)) - 3);
  start();
  run_to(5.0);
  ASSERT_EQ(clouds_.size(), 2u);
  EXPECT_EQ(clouds_[1].utime, 2 * kSecond_us);
  const health_t health = *health_.due(kStart_us);
  EXPECT_EQ(health.state, health_t::STATE_WARNING);
  EXPECT_EQ(health.message, "1 scan(s) could not be read; all scans are out");
  ASSERT_EQ(health.n_counters, 1);
  EXPECT_EQ(health.counters[0].name, "unreadable_scans");
  EXPECT_EQ(health.counters[0].count, 1);
}

TEST_F(ScanSource, StaysAfterTheLastScanAndSaysSo) {
  start();
  run_to(1.9);
  EXPECT_EQ(health_.due(kStart_us)->message, "");
  run_to(9.0);
  EXPECT_EQ(clouds_.size(), 3u);
  const health_t health = *health_.due(kStart_us + 9 * kSecond_us);
  EXPECT_EQ(health.message, "all scans are out");
  EXPECT_EQ(health.state, health_t::STATE_OK);
}

TEST_F(ScanSource, LoopsWithTimesThatGoOn) {
  config_.loop = true;
  start();
  run_to(4.0);
  ASSERT_EQ(clouds_.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_EQ(clouds_[i].utime, static_cast<std::int64_t>(i) * kSecond_us);
  EXPECT_EQ(bus::from_message(clouds_[3]).cloud->points[0].x(), 0.0F);
}

TEST_F(ScanSource, LeavesOutOdometryFromLongBeforeTheScans) {
  write("poses.csv", "index,t,x,y,yaw\n0,1000,0,0,0\n1,1001,1,0,0\n2,1002,2,0,0\n");
  write("odometry.csv", "t,x,y,yaw\n10,0,0,0\n999.5,0.1,0,0\n1001,0.2,0,0\n");
  start();
  run_to(3.0);
  EXPECT_EQ(odometry_.size(), 2u);
  EXPECT_EQ(clouds_.size(), 3u);
}

TEST_F(ScanSource, DoesNotStartWithoutAFolderNorWithOdometryOfAnotherTime) {
  write("odometry.csv", "t,x,y,yaw\n1700000000,0,0,0\n1700000001,0,0,0\n");
  EXPECT_THROW(start(), io::FileError);
  config_.folder.clear();
  EXPECT_THROW(start(), std::invalid_argument);
  config_.folder = (folder_ / "none").string();
  EXPECT_THROW(start(), io::FileError);
}

}  // namespace
}  // namespace voxlist::services
