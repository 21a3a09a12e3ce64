#include <gmock/gmock.h>

#include <map>

#include "tests/desk/scan_set.h"
#include "tests/foreign/mcap/mcap_checker.h"
#include "voxlist/bus/event_log.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class McapExport : public testing::Test {
 protected:
  test::McapFile exported() {
    test::make_scan_set(work_ / "scans");
    EXPECT_EQ(test::run({"import", work_ / "scans", "-o", log_}).exit_code, 0);
    EXPECT_EQ(test::run({"export", log_, "--mcap", file_}).exit_code, 0);
    return test::check_mcap(test::read_text(file_));
  }

  test::WorkFolder work_;
  const std::string log_ = work_ / "scans.lcm", file_ = work_ / "scans.mcap";
};

TEST_F(McapExport, KeepsEachMessageAsItWas) {
  const test::McapFile file = exported();
  EXPECT_THAT(file.wrong, IsEmpty());
  std::vector<test::McapMessage> raw;
  for (const test::McapMessage& message : file.messages)
    if (message.encoding == "x-lcm") raw.push_back(message);
  bus::EventLogReader log(log_);
  std::size_t events = 0;
  while (const auto event = log.next()) {
    ASSERT_LT(events, raw.size());
    const test::McapMessage& message = raw[events++];
    EXPECT_EQ(message.topic, event->channel);
    EXPECT_EQ(message.log_ns, static_cast<std::uint64_t>(event->utime_us) * 1000);
    EXPECT_TRUE(message.data == std::string(event->bytes.begin(), event->bytes.end()));
    const bool is_cloud = message.topic == "CLOUD";
    EXPECT_EQ(message.schema, is_cloud ? "voxlist.pointcloud_t" : "voxlist.pose_t");
    EXPECT_THAT(message.definition, HasSubstr(is_cloud ? "n_points" : "orientation[4]"));
  }
  EXPECT_EQ(events, raw.size());
}

TEST_F(McapExport, HasWhatOthersKnowBesideIt) {
  std::map<std::string, int> counts;
  for (const test::McapMessage& message : exported().messages)
    if (message.encoding == "protobuf") ++counts[message.topic + " " + message.schema];
  EXPECT_EQ(counts["/cloud foxglove.PointCloud"], test::kScans);
  EXPECT_EQ(counts["/truth foxglove.PoseInFrame"], test::kScans);
  EXPECT_EQ(counts["/odometry foxglove.PoseInFrame"], 50 * test::kScans + 1);
}

TEST_F(McapExport, LeavesAnOlderFileWhereTheLogIsNone) {
  test::write_text(file_, "an older file");
  test::write_text(work_ / "none.lcm", "no log");
  const test::DeskRun run = test::run({"export", work_ / "none.lcm", "--mcap", file_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("no message that can be read"));
  EXPECT_EQ(test::read_text(file_), "an older file");
}

TEST_F(McapExport, SaysWhatIsNotConverted) {
  {
    bus::EventLogWriter log(log_);
    log.write("CLOUD", 1, std::vector<std::uint8_t>{1, 2, 3});
    log.write("OTHERS", 2, std::vector<std::uint8_t>{4, 5});
    log.close();
  }
  const test::DeskRun run = test::run({"export", log_, "--mcap", file_});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("1 CLOUD/truncated are in the file, but not converted"));
  const test::McapFile file = test::check_mcap(test::read_text(file_));
  ASSERT_EQ(file.messages.size(), 2U);
  EXPECT_EQ(file.messages[1].topic, "OTHERS");
  EXPECT_EQ(file.messages[1].schema, "");
}

TEST_F(McapExport, WantsToKnowWhatToWrite) {
  EXPECT_NE(test::run({"export", log_}).exit_code, 0);
  EXPECT_NE(test::run({"export", log_, "--mcap", file_, "-o", work_ / "out"}).exit_code, 0);
}

}  // namespace
}  // namespace voxlist::desk
