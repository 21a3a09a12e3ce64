#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "tests/desk/scan_set.h"

namespace voxlist::desk {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr auto kSettings =
    "# the simulated robot\n"
    "[simulator]\n"
    "stand_in_room = 0\n"
    "people = 1\n"
    "mirror_phase_0_deg = 0.25\n"
    "mirror_phase_1_deg = -0.2\n"
    "mirror_height_m = 0.105\n"
    "mirror_offset_0_m = 0.004\n"
    "axis_yaw_deg = 0.3\n"
    "\n"
    "[cloud_assembler]\n"
    "mirror_height_m = 0.1 # from the drawing\n"
    "axis_roll_deg = 0.0\n"
    "\n"
    "[mapper]\n";

class Calibrate : public testing::Test {
 protected:
  Calibrate() { test::write_text(robot_, kSettings); }

  test::DeskRun simulate(const std::string& seconds) {
    return test::run({"simulate", "--config", robot_, "--seconds", seconds, "-o", log_});
  }

  // The value of a key in the robot's settings.
  double setting(const std::string& key) const {
    const std::string text = test::read_text(robot_);
    const std::string before = "\n" + key + " = ";
    return std::atof(text.c_str() + text.rfind(before) + before.size());
  }

  test::WorkFolder work_;
  const std::string robot_ = work_ / "robot.toml", log_ = work_ / "still.lcm";
};

TEST_F(Calibrate, WritesWhatItFindsIntoTheRobotsSettingsAndKeepsTheRest) {
  ASSERT_EQ(simulate("60").exit_code, 0);
  const test::DeskRun run = test::run({"calibrate", log_, "-o", robot_});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(StartsWith("parameter "), HasSubstr("\nlatency_ms"),
                             ContainsRegex("mirror_height_m +0.10000 +0.10[45]"),
                             HasSubstr(" mm thick before, ")));
  EXPECT_THAT(run.err, HasSubstr("latency_ms is held"));
  EXPECT_NEAR(setting("mirror_height_m"), 0.105, 0.001);
  EXPECT_NEAR(setting("axis_yaw_deg"), 0.3, 0.01);
  EXPECT_NEAR(setting("mirror_phase_0_deg") - setting("mirror_phase_1_deg"), 0.45, 0.01);
  const std::string text = test::read_text(robot_);
  EXPECT_THAT(text, StartsWith("# the simulated robot\n[simulator]\nstand_in_room = 0\n"));
  EXPECT_THAT(text, HasSubstr(" # from the drawing\naxis_roll_deg = "));
  EXPECT_THAT(text, testing::EndsWith("\n\n[mapper]\n"));
  EXPECT_THAT(text, Not(HasSubstr("latency_ms")));
}

TEST_F(Calibrate, OnlyShowsTheLinesWithoutAFileToWrite) {
  ASSERT_EQ(simulate("30").exit_code, 0);
  const test::DeskRun run = test::run({"calibrate", log_, "--config", robot_});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("\n[cloud_assembler]\nmirror_phase_0_deg = "));
  EXPECT_EQ(test::read_text(robot_), kSettings);
}

TEST_F(Calibrate, RefusesAndLeavesTheFileAloneWhenTheLogCannotTell) {
  ASSERT_EQ(simulate("5").exit_code, 0);
  const test::DeskRun run = test::run({"calibrate", log_, "-o", robot_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(run.err, HasSubstr("refused: "));
  EXPECT_EQ(test::read_text(robot_), kSettings);
}

TEST_F(Calibrate, FindsInAStillRecordingWhatItWasMadeWith) {
  test::write_text(robot_, "[simulator]\nmirror_height_m = 0.105\n");
  const std::string part = work_ / "room.lcm.00";
  ASSERT_EQ(test::run({"simulate", "--still", "-o", part, "--config", robot_}).exit_code, 0);
  const test::DeskRun run = test::run({"calibrate", work_ / "room.lcm", "-o", robot_});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NEAR(setting("mirror_height_m"), 0.105, 0.001);
}

TEST_F(Calibrate, TakesTheRobotsPrefix) {
  test::write_text(robot_, "[bus]\nprefix = 'a/'\n" + std::string(kSettings));
  ASSERT_EQ(simulate("30").exit_code, 0);
  EXPECT_THAT(test::run({"calibrate", log_}).err, HasSubstr("has no LASER; it holds a/CLOUD ("));
  EXPECT_EQ(test::run({"calibrate", log_, "--config", robot_}).exit_code, 0);
}

TEST_F(Calibrate, SaysThatALogHasNoLines) {
  test::write_text(log_, "");
  const test::DeskRun run = test::run({"calibrate", log_});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("has no LASER"));
}

}  // namespace
}  // namespace voxlist::desk
