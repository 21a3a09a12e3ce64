#include "services/voxlist/recording/scan_input.h"

#include <gmock/gmock.h>

#include <algorithm>
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
  std::vector<Scan> read(const std::string& path, const std::string& prefix = {}) {
    ScanInput input(path, console_, {}, prefix);
    std::vector<Scan> scans;
    while (auto scan = input.next()) scans.push_back(std::move(*scan));
    omissions_ = input.omissions().summary();
    EXPECT_EQ(input.progress(), 1.0);
    return scans;
  }

  std::string refusal(const std::string& path, const std::string& prefix = {}) {
    try {
      ScanInput input(path, console_, {}, prefix);
      while (input.next()) {
      }
    } catch (const std::exception& error) {
      return error.what();
    }
    return "not refused";
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

// At that many milliseconds.
void write_cloud(bus::EventLogWriter& log, std::int64_t time_ms, std::int32_t seq = 0) {
  const std::int64_t utime_us = 1000 * time_ms;
  log.write(bus::kCloud, utime_us, bus::to_message(cloud_at(utime_us), "base", seq));
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
    log.write(bus::kOdometry, 100, bus::to_message(StampedPose2{100'000, {1.0, 2.0, 0.5}}));
    log.write(bus::kOdometry, 300, bus::to_message(StampedPose2{300'000, {7.0, 7.0, 0.7}}));
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
    write_cloud(log, 1000);
    log.write("CLOUD", 2, std::vector<std::uint8_t>(40, 0xff));
    log.write("ODOMETRY", 3, std::vector<std::uint8_t>(3, 0));
    log.write("SOMETHING_ELSE", 3, std::vector<std::uint8_t>(3, 0));
    write_cloud(log, 4000);
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

TEST_F(ScanInputs, CountTheCloudsThatALogLost) {
  {
    bus::EventLogWriter log(work_ / "log");
    for (const int seq : {7, 8, 10, 11}) write_cloud(log, 100 * seq, seq);
    write_cloud(log, 5000, 0);  // the sender started anew
    write_cloud(log, 6000, 2);
  }
  std::vector<std::int64_t> numbers;
  for (const Scan& scan : read(work_ / "log")) numbers.push_back(scan.number);
  EXPECT_EQ(numbers, (std::vector<std::int64_t>{0, 1, 3, 4, 5, 7}));
}

TEST_F(ScanInputs, NameWhatALogWithoutScansHolds) {
  {
    bus::EventLogWriter log(work_ / "log");
    for (int i = 0; i < 3; ++i) log.write("VELODYNE_POINTS", i, std::vector<std::uint8_t>(3, 0));
    log.write("a/CLOUD", 5, std::vector<std::uint8_t>(3, 0));
  }
  EXPECT_THAT(refusal(work_ / "log"), HasSubstr("has no CLOUD; it holds VELODYNE_POINTS (3), "
                                                "a/CLOUD (1)"));
}

TEST_F(ScanInputs, KnowMillisecondsOfASlowScanner) {
  {
    bus::EventLogWriter log(work_ / "log");
    for (int i = 0; i < 4; ++i)
      write_cloud(log, 1'700'000'000 + i);  // each a second, in milliseconds
  }
  EXPECT_THAT(refusal(work_ / "log"), HasSubstr("utime looks like milliseconds"));
}

TEST_F(ScanInputs, TellOfWhichRobotALogIs) {
  {
    bus::EventLogWriter log(work_ / "log", "robot2/");
    for (int i = 0; i < 4; ++i) write_cloud(log, 1000 * i);
  }
  EXPECT_THAT(refusal(work_ / "log"),
              HasSubstr("has no CLOUD; it holds robot2/CLOUD (4): give --prefix robot2/, or the "
                        "robot's settings with --config"));
  EXPECT_EQ(read(work_ / "log", "robot2/").size(), 4u);
  EXPECT_THAT(refusal(work_ / "log", "robot1/"), HasSubstr("has no robot1/CLOUD; it holds "));
}

TEST_F(ScanInputs, ReadAllPartsOfARecording) {
  for (const int part : {0, 1, 3}) {
    bus::EventLogWriter log(work_ / ("run.lcm.0" + std::to_string(part)));
    for (int i = 0; i < 2; ++i) write_cloud(log, 1000 * (2 * part + i), 2 * part + i);
  }
  EXPECT_EQ(read(work_ / "run.lcm").size(), 6u);
  EXPECT_EQ(omissions_, "1 missing parts");
  EXPECT_THAT(err_.str(), HasSubstr("run.lcm.02 is not there"));
  EXPECT_EQ(read(work_ / "run.lcm.01").size(), 2u);
  EXPECT_THAT(err_.str(),
              HasSubstr("run.lcm.01 is one part of a recording: give " + (work_ / "run.lcm")));
}

TEST_F(ScanInputs, RefuseTimesThatAreNoMicroseconds) {
  const auto refused = [this](const std::vector<std::int64_t>& utimes_us) {
    bus::EventLogWriter log(work_ / "log");
    for (const auto utime_us : utimes_us)
      log.write(bus::kCloud, 0, bus::to_message(cloud_at(utime_us), "base", 0));
    log.close();
    return refusal(work_ / "log");
  };
  constexpr std::int64_t kNow_s = 1'700'000'000;
  EXPECT_THAT(refused({kNow_s * 1'000'000'000, kNow_s * 1'000'000'000 + 5}),
              HasSubstr("looks like nanoseconds, it must be in microseconds: divide it by 1000"));
  EXPECT_THAT(refused({kNow_s, kNow_s + 1, kNow_s + 2, kNow_s + 3}),
              HasSubstr("1 us apart: utime looks like seconds"));
  EXPECT_THAT(refused({kNow_s, kNow_s + 1}), HasSubstr("looks like seconds"));
  EXPECT_THAT(refused({kNow_s * 1000, kNow_s * 1000 + 100, kNow_s * 1000 + 200}),
              HasSubstr("100 us apart: utime looks like milliseconds"));
  EXPECT_THAT(refused({0, 0, 0}), HasSubstr("every scan has the utime 0"));
  EXPECT_THAT(refused({7, 7}), HasSubstr("every scan has the utime 7"));
  EXPECT_THAT(refused({3'000'000, 2'000'000, 1'000'000}), HasSubstr("run backwards"));
}

TEST_F(ScanInputs, LeaveOutAScanThatIsNoLaterThanTheOneBefore) {
  {
    bus::EventLogWriter log(work_ / "log");
    for (const int time_ms : {1000, 2000, 2000, 1500, 3000}) write_cloud(log, time_ms);
  }
  EXPECT_EQ(read(work_ / "log").size(), 3u);
  EXPECT_EQ(omissions_, "1 CLOUD/utime backwards, 1 CLOUD/utime repeated");
}

TEST_F(ScanInputs, AskAboutScansThatComeMinutesApart) {
  {
    bus::EventLogWriter log(work_ / "log");
    for (const int s : {0, 1000, 2000}) write_cloud(log, 1000 * s);
  }
  EXPECT_EQ(read(work_ / "log").size(), 3u);
  EXPECT_THAT(err_.str(), HasSubstr("1000 s apart: is utime in nanoseconds?"));
}

TEST_F(ScanInputs, TellWhatIsOddWithPoints) {
  const auto told = [this](const std::vector<Eigen::Vector3f>& points) {
    {
      Cloud cloud = cloud_at(1'000'000);
      cloud.points = points;
      bus::EventLogWriter log(work_ / "log");
      log.write(bus::kCloud, 0, bus::to_message(cloud, "base", 0));
    }
    err_.str("");
    read(work_ / "log");
    return err_.str();
  };
  std::vector<Eigen::Vector3f> points(60, {3000.0F, 0.0F, 0.0F});
  EXPECT_THAT(told(points), HasSubstr("60 of 60 points lie beyond max_range_m, 100 m, half of them "
                                      "beyond 3000 m: are they millimetres?"));
  points.assign(60, {458'000.0F, 5'429'000.0F, 0.0F});
  EXPECT_THAT(told(points), HasSubstr("60 of 60 points lie beyond"));
  points.assign(60, {3.0F, 0.0F, 0.0F});
  EXPECT_EQ(told(points), "");
  std::fill_n(points.begin(), 20, Eigen::Vector3f::Zero());
  EXPECT_THAT(told(points), HasSubstr("20 of 60 points are 0,0,0 or nearer than min_range_m"));
  EXPECT_THAT(told({{3.0F, 0.0F, 0.0F}}), HasSubstr("has 1 points"));
}

}  // namespace
}  // namespace voxlist::desk
