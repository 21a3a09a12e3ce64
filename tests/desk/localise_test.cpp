#include <gmock/gmock.h>

#include <sstream>

#include "tests/desk/scan_set.h"
#include "voxlist/io/poses/csv_table.h"
#include "voxlist/io/poses/pose_file.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Localise : public testing::Test {
 protected:
  Localise() {
    test::make_scan_set(scans_);
    EXPECT_EQ(test::run({"map", scans_, "-o", map_, "--use-poses", scans_ + "/poses.csv",
                         "--octomap-resolution", "1"})
                  .exit_code,
              0);
  }

  test::DeskRun localise(const std::string& input) {
    return test::run({"localise", map_, input, "-o", result_});
  }

  test::WorkFolder work_;
  const std::string scans_ = work_ / "scans", map_ = work_ / "map", result_ = work_ / "result.csv";
};

TEST_F(Localise, WritesOneRowAScanUnderTheAgreedHeader) {
  const test::DeskRun run = localise(scans_);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, StartsWith("12 scans: "));
  const auto lines = test::read_lines(result_);
  ASSERT_EQ(lines.size(), 1u + test::kScans);
  EXPECT_EQ(lines[0], "index,state,x_m,y_m,yaw_rad,overlap,confidence,elapsed_ms");
  for (int scan = 0; scan < test::kScans; ++scan)
    EXPECT_THAT(lines[static_cast<std::size_t>(scan) + 1], StartsWith(std::to_string(scan) + ","));
}

TEST_F(Localise, IsRightWhereItSaysThatItIsSure) {
  ASSERT_EQ(localise(scans_).exit_code, 0);
  const io::CsvTable table(result_);
  const io::PoseTable found = io::read_pose_csv(result_),
                      truth = io::read_pose_csv(scans_ + "/poses.csv");
  int sure = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.text(row, *table.column({"state"})) != "TRACKING") continue;
    ++sure;
    const Pose2 pose = to_pose2(found.rows[row].pose), expected = to_pose2(truth.rows[row].pose);
    EXPECT_LT(distance_m(pose, expected), 0.1) << row;
    EXPECT_LT(turn_rad(pose, expected), 0.05) << row;
  }
  EXPECT_GT(sure, 0);
}

TEST_F(Localise, MatchesOnlyTheHeightsThatItIsTold) {
  const auto matched_at = [&](const char* low, const char* high) {
    return test::run({"localise", map_, scans_, "-o", result_, "--match-heights", low, high});
  };
  EXPECT_THAT(matched_at("-1", "9").out, StartsWith(localise(scans_).out.substr(0, 40)));
  EXPECT_THAT(matched_at("50", "60").out, HasSubstr(" 0 TRACKING, 0 AMBIGUOUS"));
  const test::DeskRun none = matched_at("2", "1");
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("match_heights_m"));
}

TEST_F(Localise, FindsTheSameInAMapWhosePosesHaveAHeight) {
  const auto without_time = [&] {
    std::string rows;
    for (const std::string& line : test::read_lines(result_))
      rows += line.substr(0, line.rfind(',')) + '\n';
    return rows;
  };
  ASSERT_EQ(localise(scans_).exit_code, 0);
  const std::string level = without_time();
  EXPECT_THAT(level, HasSubstr("TRACKING"));

  std::string lifted;
  for (const std::string& line : test::read_lines(scans_ + "/poses.csv"))
    lifted += line + (lifted.empty() ? ",z" : ",0.6") + '\n';
  test::write_text(work_ / "lifted.csv", lifted);
  const test::DeskRun run = test::run({"map", scans_, "-o", map_, "--use-poses",
                                       work_ / "lifted.csv", "--octomap-resolution", "1"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("heights are counted from 0.60 m"));
  ASSERT_EQ(localise(scans_).exit_code, 0);
  EXPECT_EQ(without_time(), level);
}

TEST_F(Localise, LeavesThePoseOfAScanEmptyThatFitsNowhere) {
  test::write_text(scans_ + "/scan_3.ply",
                   "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                   "property float z\nend_header\n");
  ASSERT_EQ(localise(scans_).exit_code, 0);
  EXPECT_THAT(test::read_lines(result_)[4], StartsWith("3,LOST,,,,0.000000,0.000000,"));
}

TEST_F(Localise, KeepsTheNumbersOfScansAfterADamagedOne) {
  test::write_text(scans_ + "/scan_3.ply", "damaged");
  const test::DeskRun run = localise(scans_);
  ASSERT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("left out: 1 unreadable"));
  const auto lines = test::read_lines(result_);
  ASSERT_EQ(lines.size(), 0u + test::kScans);
  EXPECT_THAT(lines[3], StartsWith("2,"));
  EXPECT_THAT(lines[4], StartsWith("4,"));
}

}  // namespace
}  // namespace voxlist::desk
