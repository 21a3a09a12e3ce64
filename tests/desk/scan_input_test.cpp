#include "services/voxlist/recording/scan_input.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <sstream>
#include <voxlist/pose_t.hpp>

#include "tests/desk/scan_set.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/event_log.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;

class ScanInputs : public testing::Test {
 protected:
  std::vector<Scan> read(const std::string& path) {
    ScanInput input(path, console_);
    std::vector<Scan> scans;
    while (auto scan = input.next()) scans.push_back(std::move(*scan));
    omissions_ = input.omissions().summary();
    EXPECT_EQ(input.progress(), 1.0);
    return scans;
  }

  test::WorkFolder work_;
  std::ostringstream out_, err_;
  Console console_{out_, err_, false};
  std::string omissions_;
};

Cloud cloud_at(std::int64_t utime_us) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  cloud.points = {{1.0F, 2.0F, 3.0F}};
  return cloud;
}

void write_cloud(bus::EventLogWriter& log, std::int64_t utime_us) {
  log.write(bus::kCloud, utime_us, bus::to_message(cloud_at(utime_us), "base", 0));
}

TEST_F(ScanInputs, GiveTheSameScansFromAFolderAndFromItsLog) {
  test::make_scan_set(work_ / "scans");
  ASSERT_EQ(test::run({"import", work_ / "scans", "-o", work_ / "log"}).exit_code, 0);
  const auto folder = read(work_ / "scans"), log = read(work_ / "log");
  ASSERT_EQ(folder.size(), static_cast<std::size_t>(test::kScans));
  ASSERT_EQ(log.size(), folder.size());
  for (std::size_t i = 0; i < log.size(); ++i) {
    EXPECT_EQ(log[i].number, static_cast<std::int64_t>(i));
    EXPECT_EQ(folder[i].number, log[i].number);
    EXPECT_EQ(folder[i].cloud.utime_us, log[i].cloud.utime_us);
    EXPECT_EQ(folder[i].cloud.points, log[i].cloud.points);
    EXPECT_EQ(folder[i].cloud.origins, log[i].cloud.origins);
    ASSERT_TRUE(log[i].T_odom_base);
    EXPECT_EQ(folder[i].T_odom_base, log[i].T_odom_base);
  }
}

TEST_F(ScanInputs, TellWhereOdometryStoodAtEachScan) {
  {
    bus::EventLogWriter log(work_ / "log");
    write_cloud(log, 50);
    log.write(bus::kOdometry, 100, bus::to_message(StampedPose2{100, {1.0, 2.0, 0.5}}));
    log.write(bus::kOdometry, 300, bus::to_message(StampedPose2{300, {7.0, 7.0, 0.7}}));
    write_cloud(log, 200);
  }
  const auto scans = read(work_ / "log");
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_FALSE(scans[0].T_odom_base);
  ASSERT_TRUE(scans[1].T_odom_base);
  EXPECT_NEAR(scans[1].T_odom_base->x_m, 1.0, 1e-12);
  EXPECT_NEAR(scans[1].T_odom_base->yaw_rad, 0.5, 1e-12);
}

TEST_F(ScanInputs, CountForgedMessagesAndKeepTheNumbersOfTheOthers) {
  {
    bus::EventLogWriter log(work_ / "log");
    write_cloud(log, 1);
    log.write("CLOUD", 2, std::vector<std::uint8_t>(40, 0xff));
    log.write("ODOMETRY", 3, std::vector<std::uint8_t>(3, 0));
    log.write("SOMETHING_ELSE", 3, std::vector<std::uint8_t>(3, 0));
    write_cloud(log, 4);
  }
  const auto scans = read(work_ / "log");
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[1].number, 2);
  EXPECT_EQ(omissions_, "1 CLOUD/wrong_type, 1 ODOMETRY/truncated");
  EXPECT_THAT(err_.str(), HasSubstr("CLOUD in event 1 is wrong_type"));
}

TEST_F(ScanInputs, ReadALogThatWasTornAtItsEnd) {
  {
    bus::EventLogWriter log(work_ / "log");
    write_cloud(log, 1);
    write_cloud(log, 2);
  }
  std::filesystem::resize_file(work_ / "log", std::filesystem::file_size(work_ / "log") - 5);
  EXPECT_EQ(read(work_ / "log").size(), 1u);
  EXPECT_EQ(omissions_, "1 damaged events");
}

TEST_F(ScanInputs, TellOnlyTheFirstFewOfManyFaults) {
  {
    bus::EventLogWriter log(work_ / "log");
    write_cloud(log, 1);
    for (int i = 0; i < 1000; ++i) log.write("CLOUD", i, std::vector<std::uint8_t>(3, 0));
  }
  EXPECT_EQ(read(work_ / "log").size(), 1u);
  EXPECT_EQ(omissions_, "1000 CLOUD/truncated");
  EXPECT_LT(err_.str().size(), 1000u);
}

}  // namespace
}  // namespace voxlist::desk
