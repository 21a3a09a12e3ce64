// A laser's mount from a simulated drive, through the desk tool.
#include <gmock/gmock.h>

#include <regex>

#include "tests/bench/adapter/mounted_drive.h"
#include "tests/desk/scan_set.h"

namespace voxlist::desk {
namespace {

using testing::HasSubstr;

constexpr char kSettings[] =
    "# my robot\n[[cloud_adapter.sensor]]\nchannel = \"LASER_3D\" # in front\ntime_channel = "
    "\"time\"\n"
    "mount_pitch_deg = 0.0 # about\n";

// A number of the settings; NaN when it is not there.
double value(const std::string& settings, const std::string& key) {
  std::smatch found;
  return std::regex_search(settings, found, std::regex(key + " = ([-0-9.]+)"))
             ? std::stod(found[1].str())
             : NAN;
}

class CalibrateLaser : public testing::Test {
 protected:
  CalibrateLaser() { test::write_text(settings_, kSettings); }

  test::DeskRun calibrate() { return test::run({"calibrate", "--laser", log_, "-o", settings_}); }

  test::WorkFolder work_;
  const std::string log_ = work_ / "drive.lcm", settings_ = work_ / "robot.toml";
};

TEST_F(CalibrateLaser, WritesMountAndLatencyOfADrive) {
  bench::write_drive(log_,
                     {.roll_deg = -3.0,
                      .pitch_deg = 8.0,
                      .yaw_deg = 35.0,
                      .x_m = 0.25,
                      .y_m = -0.1,
                      .z_m = 0.9,
                      .latency_ms = 15.0,
                      .rays = 1'600},
                     80.0, 7);
  const test::DeskRun run = calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string settings = test::read_text(settings_);
  EXPECT_THAT(settings, HasSubstr("channel = \"LASER_3D\" # in front"));
  EXPECT_NEAR(value(settings, "mount_roll_deg"), -3.0, 0.1);
  EXPECT_NEAR(value(settings, "mount_pitch_deg"), 8.0, 0.1);
  EXPECT_NEAR(value(settings, "mount_z_m"), 0.9, 0.005);
  EXPECT_NEAR(value(settings, "mount_yaw_deg"), 35.0, 0.2);
  EXPECT_NEAR(value(settings, "mount_x_m"), 0.25, 0.02);
  EXPECT_NEAR(value(settings, "mount_y_m"), -0.1, 0.02);
  EXPECT_NEAR(value(settings, "latency_ms"), 15.0, 3.0);
}

TEST_F(CalibrateLaser, HoldsWhatADriveTooShortDoesNotTell) {
  bench::write_drive(log_, {.pitch_deg = 8.0}, 2.5, 7);
  const test::DeskRun run = calibrate();
  EXPECT_THAT(run.err, HasSubstr("refused: mount_yaw_deg: this drive does not tell it"));
  const std::string settings = test::read_text(settings_);
  EXPECT_TRUE(std::isnan(value(settings, "mount_yaw_deg")));
  EXPECT_NEAR(value(settings, "mount_pitch_deg"), 8.0, 0.1) << "the floor tells it";
}

TEST_F(CalibrateLaser, NeedsASensor) {
  test::write_text(settings_, "");
  bench::write_drive(log_, {}, 0.5, 7);
  EXPECT_THAT(calibrate().err, HasSubstr("has no [[cloud_adapter.sensor]]"));
}

}  // namespace
}  // namespace voxlist::desk
