#include <gmock/gmock.h>
#include <lcm/eventlog.h>

#include <filesystem>
#include <map>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "tests/desk/scan_set.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/event_log.h"
#include "voxlist/io/clouds/cloud_file.h"
#include "voxlist/io/poses/pose_file.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;

class Import : public testing::Test {
 protected:
  Import() { test::make_scan_set(scans_); }

  std::vector<bus::Event> import_and_read() {
    EXPECT_EQ(test::run({"import", scans_, "-o", log_}).exit_code, 0);
    std::vector<bus::Event> events;
    bus::EventLogReader reader(log_);
    while (auto event = reader.next()) events.push_back(std::move(*event));
    EXPECT_EQ(reader.damaged_events(), 0);
    return events;
  }

  test::WorkFolder work_;
  const std::string scans_ = work_ / "scans", log_ = work_ / "scans.lcmlog";
};

template <class M>
M decoded(const bus::Event& event) {
  M message;
  EXPECT_EQ(bus::decode(event.bytes, message), bus::Fault::kNone);
  return message;
}

TEST_F(Import, KeepsScansOdometryAndTruthInTheOrderOfTheirTimes) {
  std::map<std::string, int> counts;
  std::int64_t last_us = 0, last_odometry_us = -1, last_truth_us = -1;
  for (const bus::Event& event : import_and_read()) {
    ++counts[event.channel];
    EXPECT_GE(event.utime_us, last_us);
    last_us = event.utime_us;
    if (event.channel == "ODOMETRY") last_odometry_us = event.utime_us;
    if (event.channel == "TRUTH") last_truth_us = event.utime_us;
    if (event.channel != "CLOUD") continue;
    EXPECT_EQ(last_odometry_us, event.utime_us);
    EXPECT_EQ(last_truth_us, event.utime_us);
    EXPECT_EQ(decoded<pointcloud_t>(event).utime, event.utime_us);
  }
  EXPECT_EQ(counts["CLOUD"], test::kScans);
  EXPECT_EQ(counts["TRUTH"], test::kScans);
  EXPECT_EQ(counts["ODOMETRY"], 50 * test::kScans + 1);
  EXPECT_EQ(counts.size(), 3u);
}

TEST_F(Import, KeepsEveryPointOriginAndPose) {
  const io::PoseTable poses = io::read_pose_csv(scans_ + "/poses.csv");
  std::size_t scan = 0;
  for (const bus::Event& event : import_and_read()) {
    if (event.channel == "TRUTH") {
      const auto truth = bus::from_message(decoded<pose_t>(event));
      ASSERT_TRUE(truth);
      EXPECT_TRUE(truth->pose.isApprox(poses.rows[scan].pose, 1e-12));
    }
    if (event.channel != "CLOUD") continue;
    const auto received = bus::from_message(decoded<pointcloud_t>(event));
    ASSERT_TRUE(received.cloud);
    const Cloud written = io::read_cloud_file(scans_ + "/scan_" + std::to_string(scan++) + ".ply");
    EXPECT_GT(written.points.size(), 1000u);
    EXPECT_EQ(received.cloud->points, written.points);
    EXPECT_EQ(received.cloud->origins, written.origins);
  }
  EXPECT_EQ(scan, static_cast<std::size_t>(test::kScans));
}

TEST_F(Import, WritesWhatLcmReads) {
  const std::vector<bus::Event> events = import_and_read();
  lcm_eventlog_t* log = lcm_eventlog_create(log_.c_str(), "r");
  ASSERT_NE(log, nullptr);
  std::size_t count = 0;
  while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log)) {
    if (count < events.size()) {
      EXPECT_EQ(event->channel, events[count].channel);
      EXPECT_EQ(event->timestamp, events[count].utime_us);
    }
    ++count;
    lcm_eventlog_free_event(event);
  }
  lcm_eventlog_destroy(log);
  EXPECT_EQ(count, events.size());
  EXPECT_GT(count, 50u * test::kScans);
}

TEST_F(Import, LeavesOutADamagedScanAndSaysSo) {
  test::write_text(scans_ + "/scan_3.ply", "ply\nformat nonsense\n");
  const test::DeskRun run = test::run({"import", scans_, "-o", log_});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr(std::to_string(test::kScans - 1) + " CLOUD"));
  EXPECT_THAT(run.err, HasSubstr("scan_3.ply"));
  EXPECT_THAT(run.err, HasSubstr("left out: 1 unreadable"));
}

TEST_F(Import, LeavesTheOldLogAloneWhenItFails) {
  test::write_text(log_, "old");
  for (int scan = 0; scan < test::kScans; ++scan)
    test::write_text(scans_ + "/scan_" + std::to_string(scan) + ".ply", "damaged");
  EXPECT_EQ(test::run({"import", scans_, "-o", log_}).exit_code, 1);
  EXPECT_EQ(test::read_text(log_), "old");
  const std::filesystem::directory_iterator left(work_ / "");
  EXPECT_EQ(std::distance(begin(left), end(left)), 2);
}

}  // namespace
}  // namespace voxlist::desk
