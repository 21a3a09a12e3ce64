// Raw scans of a laser that is not in base, through the desk tool.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "tests/desk/raw_scan_set.h"
#include "tests/desk/scan_set.h"
#include "voxlist/io/poses/pose_file.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;

class Adapted : public testing::Test {
 protected:
  Adapted() {
    set_.write(scans_);
    test::write_text(settings_, test::RawScanSet::settings());
  }

  test::DeskRun map(const std::string& input, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"map", input, "-o", map_, "--no-octomap"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::run(arguments);
  }

  // The greatest error of the poses that were found, as they lie to the first.
  double greatest_error_m() const {
    const io::PoseTable found = io::read_poses(map_ + "/trajectory.tum");
    if (found.rows.size() != test::RawScanSet::kScans) return INFINITY;
    const io::PoseRow& first = found.rows.front();
    double greatest_m = 0.0;
    for (const io::PoseRow& row : found.rows) {
      const Pose2 expected = set_.truth(first.utime_us).inverse() * set_.truth(row.utime_us);
      const Pose2 is = to_pose2(first.pose).inverse() * to_pose2(row.pose);
      greatest_m = std::max(greatest_m, distance_m(is, expected));
    }
    return greatest_m;
  }

  static std::string hash_of(const test::DeskRun& run) {
    std::smatch found;
    return std::regex_search(run.out, found, std::regex("hash ([0-9a-f]+)")) ? found[1].str()
                                                                             : "none";
  }

  const test::RawScanSet set_;
  test::WorkFolder work_;
  const std::string scans_ = work_ / "scans", map_ = work_ / "map",
                    settings_ = work_ / "robot.toml";
};

TEST_F(Adapted, FolderOfRawScansMapsToAFewMillimetres) {
  const test::DeskRun run = map(scans_, {"--config", settings_});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("16 of 16 scans placed"));
  EXPECT_LT(greatest_error_m(), 0.015);
}

TEST_F(Adapted, LogOfRawScansGivesTheSameMapAsTheirFolder) {
  const std::string log = work_ / "raw.lcm";
  const test::DeskRun import = test::run({"import", scans_, "-o", log, "--channel", "LASER_3D"});
  ASSERT_EQ(import.exit_code, 0) << import.err;
  EXPECT_THAT(import.out, HasSubstr("16 LASER_3D"));
  const test::DeskRun of_log = map(log, {"--config", settings_, "--force"});
  ASSERT_EQ(of_log.exit_code, 0) << of_log.err;
  const test::DeskRun of_folder = map(scans_, {"--config", settings_, "--force"});
  EXPECT_EQ(hash_of(of_log), hash_of(of_folder));
  EXPECT_NE(hash_of(of_log), "none");
}

TEST_F(Adapted, ScansAreFoundByThemselves) {
  ASSERT_EQ(map(scans_, {"--config", settings_}).exit_code, 0);
  const test::DeskRun run =
      test::run({"localise", map_, scans_, "-o", work_ / "result.csv", "--config", settings_});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::smatch found;
  ASSERT_TRUE(std::regex_search(run.out, found, std::regex("16 scans: (\\d+) TRACKING")))
      << run.out;
  EXPECT_GE(std::stoi(found[1].str()), 12);
}

TEST_F(Adapted, SaysWhatIsWrongWithTheSettings) {
  test::write_text(settings_, test::RawScanSet::settings() + "mount_z = 1\n");
  EXPECT_THAT(map(scans_, {"--config", settings_}).err,
              HasSubstr("no key cloud_adapter.sensor.mount_z"));
  test::write_text(settings_, "[[cloud_adapter.sensor]]\nmount_z_m = 1.0\n");
  EXPECT_THAT(map(scans_, {"--config", settings_}).err,
              HasSubstr("[cloud_adapter] sensor.channel must be set"));
}

TEST_F(Adapted, SaysThatTheScansHaveNoSuchTimes) {
  std::string text = test::RawScanSet::settings();
  text.replace(text.find("\"time\""), 6, "\"t\"");
  test::write_text(settings_, text);
  const test::DeskRun run = map(scans_, {"--config", settings_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("LASER_3D has no channel \"t\" (time_channel); it has: time, "
                                 "ring"));
  EXPECT_THAT(run.err, HasSubstr("none of its 16 raw scans became a cloud"));
}

TEST_F(Adapted, ScansInBaseStayAsTheyAre) {
  const std::string scans = work_ / "in_base";
  test::make_scan_set(scans);
  const test::DeskRun plain = map(scans, {"--force"});
  const test::DeskRun with = map(scans, {"--force", "--config", settings_});
  EXPECT_EQ(hash_of(plain), hash_of(with));
  EXPECT_THAT(with.err, HasSubstr("they are in base already"));
}

TEST_F(Adapted, NeedsOneSensorForAFolder) {
  test::write_text(
      settings_, test::RawScanSet::settings() + "[[cloud_adapter.sensor]]\nchannel = \"OTHER\"\n");
  EXPECT_THAT(map(scans_, {"--config", settings_}).err,
              HasSubstr("but [cloud_adapter] has 2 sensors"));
}

TEST_F(Adapted, ImportRefusesAChannelThatMeansSomethingElse) {
  for (const char* channel : {"CLOUD", "a b", ""})
    EXPECT_NE(test::run({"import", scans_, "-o", work_ / "log", "--channel", channel}).exit_code, 0)
        << channel;
}

}  // namespace
}  // namespace voxlist::desk
