#include "voxlist/scanner/sweep/cloud_assembler.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/scanner/sweep/scanner_rig.h"

namespace voxlist::scanner {
namespace {

constexpr double kPi = std::numbers::pi;

// Everything that came out.
struct Made : Assembly {
  std::vector<double> line_shares;
  std::map<std::string, std::int64_t> named;

  void operator+=(const Assembly& part) {
    clouds.insert(clouds.end(), part.clouds.begin(), part.clouds.end());
    slices.insert(slices.end(), part.slices.begin(), part.slices.end());
    if (part.line_share) line_shares.push_back(*part.line_share);
    for (const auto& [what, times] : by_counter_name(part.counts)) named[what] += times;
  }

  std::int64_t counted(const std::string& what) const {
    const auto found = named.find(what);
    return found == named.end() ? 0 : found->second;
  }
};

CloudAssemblerConfig config_for(const ScannerRig& rig) {
  CloudAssemblerConfig config;
  config.geometry = rig.geometry;
  config.staircase = rig.staircase;
  return config;
}

CloudAssemblerConfig standing_config(const ScannerRig& rig) {
  CloudAssemblerConfig config = config_for(rig);
  config.use_odometry = false;
  return config;
}

// A scanner that is not what its drawing says, in every way.
ScannerRig crooked_rig() {
  ScannerRig rig;
  rig.geometry.mirror_phase_0_deg = 0.25;
  rig.geometry.mirror_phase_1_deg = -0.2;
  rig.geometry.mirror_height_m = 0.105;
  rig.geometry.mirror_offset_0_m = 0.003;
  rig.geometry.mirror_offset_1_m = 0.001;
  rig.geometry.axis_yaw_deg = 0.3;
  rig.geometry.axis_roll_deg = -0.3;
  rig.geometry.mount_x_m = 0.2;
  rig.geometry.mount_roll_deg = 1.0;
  rig.geometry.mount_pitch_deg = -2.0;
  rig.geometry.mount_yaw_deg = 30.0;
  return rig;
}

// 0.5 m/s and 45 deg/s.
Pose2 circle(double t_s) {
  const double yaw_rad = kPi / 4.0 * t_s, radius_m = 0.5 / (kPi / 4.0);
  return {radius_m * std::sin(yaw_rad), radius_m * (1.0 - std::cos(yaw_rad)), wrap_angle(yaw_rad)};
}

// Lines from `first` on, each with the mirror's state and odometry at 50 Hz in the order of time.
struct Player {
  Player(const ScannerRig& scanner_rig, const CloudAssemblerConfig& config)
      : rig(scanner_rig), assembler(config) {}

  void odometry_until(std::int64_t utime_us) {
    for (; odometry_us <= utime_us; odometry_us += odometry_period_us)
      made += assembler.add_odometry(rig.odometry(odometry_us));
  }
  void mirror(int index) { made += assembler.add_mirror(rig.mirror(index)); }
  void line(int index, double first_angle_deg = 0.0) {
    made += assembler.add_line(rig.line(index, first_angle_deg));
  }
  void play(int first, int lines) {
    for (int i = first; i < first + lines; ++i) {
      odometry_until(rig.line_utime_us(i) + 10'000);  // a line ends 6.7 ms after it began
      mirror(i);
      line(i);
    }
  }

  const ScannerRig& rig;
  CloudAssembler assembler;
  Made made;
  std::int64_t odometry_period_us = 20'000;
  std::int64_t odometry_us = ScannerRig::kStart_us - 100'000;
};

Made play(const ScannerRig& rig, const CloudAssemblerConfig& config, double duration_s) {
  Player player(rig, config);
  player.play(0, static_cast<int>(duration_s * 75.0));
  return player.made;
}

double rms_error_m(const ScannerRig& rig, const Cloud& cloud) {
  double sum = 0.0;
  for (const auto& point : cloud.points) sum += std::pow(rig.error_m(cloud.utime_us, point), 2);
  return std::sqrt(sum / static_cast<double>(cloud.points.size()));
}

class CloudAssemblerAtSweepTime : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Seconds, CloudAssemblerAtSweepTime, testing::Values(1.0, 3.0, 4.8));

TEST_P(CloudAssemblerAtSweepTime, StandingRobotSeesTheRoomWithinAMillimetre) {
  ScannerRig rig = crooked_rig();
  rig.sweep_s = GetParam();
  const Made made = play(rig, standing_config(rig), 2.1 * rig.sweep_s);
  ASSERT_GE(made.clouds.size(), 2u);
  for (const Cloud& cloud : made.clouds) EXPECT_LT(rms_error_m(rig, cloud), 0.001);
  const Cloud& whole = made.clouds[1];
  const double lines = rig.sweep_s * 75.0, beams = 131.0, seen = 330.0 / 360.0;
  EXPECT_GT(static_cast<double>(whole.points.size()), 0.95 * lines * beams * seen);
  RecordProperty("rms_um", static_cast<int>(1e6 * rms_error_m(rig, whole)));
}

TEST_P(CloudAssemblerAtSweepTime, DrivingAndTurningRobotSeesItWithinFiveMillimetres) {
  ScannerRig rig = crooked_rig();
  rig.sweep_s = GetParam();
  rig.T_world_base = circle;
  const Made made = play(rig, config_for(rig), 2.1 * rig.sweep_s);
  ASSERT_GE(made.clouds.size(), 2u);
  for (const Cloud& cloud : made.clouds) EXPECT_LT(rms_error_m(rig, cloud), 0.005);
  for (const Cloud& slice : made.slices) {
    if (!slice.points.empty()) {
      EXPECT_LT(rms_error_m(rig, slice), 0.005);
    }
  }
  RecordProperty("rms_um", static_cast<int>(1e6 * rms_error_m(rig, made.clouds[1])));

  const Made smeared = play(rig, standing_config(rig), 2.1 * rig.sweep_s);
  ASSERT_GE(smeared.clouds.size(), 2u);
  EXPECT_GT(rms_error_m(rig, smeared.clouds[1]), 0.05) << "the robot does not move enough";
}

TEST(CloudAssembler, FollowsAMirrorThatStandsBetweenItsSteps) {
  ScannerRig rig;
  rig.staircase = true;
  rig.sweep_s = 4.8;
  const Made stairs = play(rig, standing_config(rig), 10.0);
  ASSERT_GE(stairs.clouds.size(), 2u);
  EXPECT_LT(rms_error_m(rig, stairs.clouds[1]), 0.001);

  CloudAssemblerConfig smooth = standing_config(rig);
  smooth.staircase = false;
  EXPECT_GT(rms_error_m(rig, play(rig, smooth, 10.0).clouds.at(1)), 0.005);
}

TEST(CloudAssembler, FollowsAMirrorThatTurnsBackwards) {
  ScannerRig rig = crooked_rig();
  rig.direction = -1.0;
  const Made made = play(rig, standing_config(rig), 4.0);
  EXPECT_EQ(made.clouds.size(), 3u) << "the first and the last sweep are not whole";
  for (const Cloud& cloud : made.clouds) EXPECT_LT(rms_error_m(rig, cloud), 0.001);
}

TEST(CloudAssembler, TakesInterlacedPartsOfFinerScans) {
  const ScannerRig rig = crooked_rig();
  Player player(rig, standing_config(rig));
  for (int i = 0; i < 160; ++i) {
    player.mirror(i);
    player.line(i, 0.25 * (i % 4));
  }
  ASSERT_GE(player.made.clouds.size(), 1u);
  for (const Cloud& cloud : player.made.clouds) EXPECT_LT(rms_error_m(rig, cloud), 0.001);
}

TEST(CloudAssembler, LaserClockThatIsLateIsSetRight) {
  ScannerRig rig;
  rig.geometry.latency_ms = 4.0;
  const auto rms_m = [&rig](double latency_ms) {
    CloudAssemblerConfig config = standing_config(rig);
    config.geometry.latency_ms = latency_ms;
    CloudAssembler assembler(config);
    Made made;
    for (int i = 0; i < 200; ++i) {
      LaserLine line = rig.line(i);
      line.utime_us += 4'000;
      made += assembler.add_mirror(rig.mirror(i));
      made += assembler.add_line(line);
    }
    return rms_error_m(rig, made.clouds.at(1));
  };
  EXPECT_LT(rms_m(4.0), 0.001);
  EXPECT_GT(rms_m(0.0), 0.01);
}

TEST(CloudAssembler, CloudIsASweepInTheFrameAndAtTheTimeOfItsLastBeam) {
  const ScannerRig rig;
  Player player(rig, standing_config(rig));
  int in_sweep = 0;
  std::int64_t last_utime_us = 0;
  for (int i = 0; player.made.clouds.size() < 4u && i < 400; ++i) {
    const std::size_t before = player.made.clouds.size();
    player.play(i, 1);
    ++in_sweep;
    if (player.made.clouds.size() == before) continue;
    // It ends with the last line before phi = 0: the next begins beyond.
    const double phi_turns = rig.psi_rad(rig.seconds(rig.line_utime_us(i))) / kPi;
    EXPECT_GT(phi_turns - std::floor(phi_turns), 1.0 - 1.0 / 75.0 - 1e-6);
    const Cloud& cloud = player.made.clouds.back();
    EXPECT_EQ(cloud.utime_us, rig.line_utime_us(i) + std::llround(kLaserTurn_us / 2.0));
    if (before > 0) {
      EXPECT_EQ(in_sweep, 75);
      EXPECT_NEAR(static_cast<double>(cloud.utime_us - last_utime_us), 1e6, 20.0);
    }
    last_utime_us = cloud.utime_us;
    in_sweep = 0;
  }
  EXPECT_EQ(player.made.clouds.size(), 4u);
}

TEST(CloudAssembler, SweepsBeginWhereTheyAreToldTo) {
  const ScannerRig rig;
  CloudAssemblerConfig config = standing_config(rig);
  config.sweep_boundary_deg = 90.0;
  Player player(rig, config);
  for (int i = 0; player.made.clouds.empty() && i < 400; ++i) {
    player.play(i, 1);
    if (player.made.clouds.empty()) continue;
    const double phi_turns = rig.psi_rad(rig.seconds(rig.line_utime_us(i + 1))) / kPi;
    EXPECT_NEAR(phi_turns - std::floor(phi_turns), 0.25 + 0.5 / 75.0, 0.51 / 75.0);
  }
  EXPECT_EQ(player.made.clouds.size(), 1u);
}

TEST(CloudAssembler, RaysStartAtTheMirror) {
  ScannerRig rig;
  rig.T_world_base = circle;
  const Made made = play(rig, config_for(rig), 2.1);
  ASSERT_GE(made.clouds.size(), 1u);
  for (const Cloud& cloud : made.clouds) {
    ASSERT_EQ(cloud.origins.size(), cloud.points.size());
    const Pose2 T_world_end = rig.T_world_base(rig.seconds(cloud.utime_us));
    for (std::size_t i = 0; i < cloud.points.size(); i += 50) {
      const Eigen::Vector3f& origin = cloud.origins[i];
      EXPECT_NEAR(origin.z(), rig.geometry.mount_z_m, 0.02);
      // Where the mirror was in the second before the sweep's end.
      const double reach_m = 0.5 + 0.25;
      EXPECT_LT(origin.head<2>().norm(), reach_m);
      // The way from there to the point is free.
      const Eigen::Vector3d from = T_world_end * origin.cast<double>();
      const Eigen::Vector3d to = T_world_end * cloud.points[i].cast<double>();
      const auto free_m = rig.room.range(from, (to - from).normalized());
      ASSERT_TRUE(free_m);
      EXPECT_NEAR(*free_m, (to - from).norm(), 0.05);
    }
  }
}

TEST(CloudAssembler, SlicesTogetherAreTheCloud) {
  const ScannerRig rig;
  Player player(rig, standing_config(rig));
  player.play(0, 300);
  ASSERT_EQ(player.made.clouds.size(), 4u);
  std::vector<Eigen::Vector3f> points, sliced;
  for (const Cloud& cloud : player.made.clouds)
    points.insert(points.end(), cloud.points.begin(), cloud.points.end());
  std::int64_t last_us = 0;
  for (const Cloud& slice : player.made.slices) {
    EXPECT_GT(slice.utime_us, last_us);
    EXPECT_LE(slice.utime_us - last_us, last_us == 0 ? slice.utime_us : 70'000);
    last_us = slice.utime_us;
    if (slice.utime_us <= player.made.clouds.back().utime_us)
      sliced.insert(sliced.end(), slice.points.begin(), slice.points.end());
  }
  EXPECT_EQ(sliced, points);
}

TEST(CloudAssembler, LineThatArrivesBeforeItsMirrorAngleWaits) {
  const ScannerRig rig;
  const Made in_order = play(rig, standing_config(rig), 2.0);
  Player late(rig, standing_config(rig));
  for (int i = 0; i < 150; i += 10) {  // the states of ten lines come after those lines
    for (int k = i; k < i + 10; ++k) late.line(k);
    for (int k = i; k < i + 10; ++k) late.mirror(k);
  }
  EXPECT_EQ(late.made.counted("LASER/assembled"), 150);
  ASSERT_EQ(late.made.clouds.size(), in_order.clouds.size());
  for (std::size_t i = 0; i < in_order.clouds.size(); ++i)
    EXPECT_EQ(late.made.clouds[i].points.size(), in_order.clouds[i].points.size());
  EXPECT_LT(rms_error_m(rig, late.made.clouds.back()), 0.001);
}

TEST(CloudAssembler, LineWaitsOnlySoLongForItsMirrorAngle) {
  const ScannerRig rig;
  Player player(rig, standing_config(rig));
  for (int i = 0; i < 30; ++i) player.line(i);
  EXPECT_EQ(player.made.counted("LASER/no_mirror_yet"), 30 - 16) << "200 ms are 15 lines";
  player.mirror(29);
  EXPECT_EQ(player.made.counted("LASER/no_mirror_yet"), 30 - 16);
  EXPECT_EQ(player.made.counted("LASER/mirror_unknown") + player.made.counted("LASER/assembled"),
            16);
}

TEST(CloudAssembler, OnlySoManyLinesWait) {
  const ScannerRig rig;
  CloudAssemblerConfig config = standing_config(rig);
  config.max_waiting_lines = 4;
  Player player(rig, config);
  for (int i = 0; i < 10; ++i) player.line(i);
  EXPECT_EQ(player.made.counted("LASER/too_many_waiting"), 6);
}

TEST(CloudAssembler, OdometryThatComesLateGivesTheSameCloud) {
  ScannerRig rig;
  rig.T_world_base = circle;
  const Made in_order = play(rig, config_for(rig), 2.0);
  Player late(rig, config_for(rig));
  for (int i = 0; i < 150; ++i) {
    late.mirror(i);
    late.line(i);
    late.odometry_until(rig.line_utime_us(i) - 180'000);
  }
  late.odometry_until(rig.line_utime_us(150));
  EXPECT_EQ(late.made.counted("LASER/assembled"), 150);
  ASSERT_EQ(late.made.clouds.size(), in_order.clouds.size());
  for (std::size_t i = 0; i < in_order.clouds.size(); ++i) {
    EXPECT_EQ(late.made.clouds[i].points.size(), in_order.clouds[i].points.size());
    EXPECT_LT(rms_error_m(rig, late.made.clouds[i]), 0.005);
  }
}

TEST(CloudAssembler, MeasuredMotionReplacesWhatWasExtrapolated) {
  ScannerRig rig;
  // Swings by 45 deg/s at most, and is only asked 20 times a second.
  rig.T_world_base = [](double t_s) { return Pose2{0.0, 0.0, 0.25 * std::sin(kPi * t_s)}; };
  Player player(rig, config_for(rig));
  player.odometry_period_us = 50'000;
  player.play(0, 225);
  ASSERT_GE(player.made.clouds.size(), 3u);
  for (const Cloud& cloud : player.made.clouds) EXPECT_LT(rms_error_m(rig, cloud), 0.005);
}

TEST(CloudAssembler, MakesNoCloudWithoutTheOdometryThatItIsToUse) {
  const ScannerRig rig;
  Player player(rig, config_for(rig));
  for (int i = 0; i < 225; ++i) {
    player.mirror(i);
    player.line(i);
  }
  EXPECT_TRUE(player.made.clouds.empty());
  EXPECT_TRUE(player.made.slices.empty());
  EXPECT_EQ(player.made.counted("LASER/no_odometry"), 225 - 16);
}

TEST(CloudAssembler, HoleInOdometryCostsItsLinesOnly) {
  ScannerRig rig;
  rig.T_world_base = circle;
  Player player(rig, config_for(rig));
  player.play(0, 160);
  player.odometry_us += 1'500'000;
  player.play(160, 250);
  EXPECT_GT(player.made.counted("LASER/no_odometry"), 0);
  EXPECT_GT(player.made.clouds.size(), 2u);
  for (const Cloud& cloud : player.made.clouds) EXPECT_LT(rms_error_m(rig, cloud), 0.005);
}

TEST(CloudAssembler, LostMirrorThrowsAwayTheSweepThatItSpoils) {
  const ScannerRig rig;
  Player player(rig, standing_config(rig));
  // The rig's sweeps are lines 0-67, 68-142, 143-217 and so on.
  player.play(0, 110);
  const std::size_t before = player.made.clouds.size();
  MirrorState stalled;
  stalled.utime_us = rig.line_utime_us(110);
  stalled.state = MirrorState::State::kStalled;
  player.made += player.assembler.add_mirror(stalled);
  for (int i = 110; i < 113; ++i) player.line(i);
  EXPECT_EQ(player.made.counted("LASER/mirror_lost"), 3);
  EXPECT_EQ(player.made.counted("CLOUD/mirror_lost"), 1);
  player.play(113, 30);
  EXPECT_EQ(player.made.clouds.size(), before) << "too little is left of that sweep";
  player.play(143, 75);
  EXPECT_EQ(player.made.clouds.size(), before + 1);
  for (const Cloud& cloud : player.made.clouds) EXPECT_LT(rms_error_m(rig, cloud), 0.001);
}

TEST(CloudAssembler, SweepWithHolesGoesOutWithWhatItHasAndSaysSo) {
  const ScannerRig rig;
  Player player(rig, standing_config(rig));
  player.play(0, 100);
  player.play(115, 200);
  EXPECT_EQ(player.made.counted("LASER/missing"), 15);
  ASSERT_GE(player.made.clouds.size(), 3u);
  EXPECT_NEAR(player.made.line_shares.at(1), 60.0 / 75.0, 0.02);
  EXPECT_NEAR(player.made.line_shares.at(2), 1.0, 0.02);
  EXPECT_LT(rms_error_m(rig, player.made.clouds[1]), 0.001);
}

TEST(CloudAssembler, SweepThatIsMostlyHolesIsDropped) {
  const ScannerRig rig;
  Player player(rig, standing_config(rig));
  player.play(0, 75);
  const std::size_t before = player.made.clouds.size();
  player.play(120, 23);
  player.play(143, 75);
  EXPECT_EQ(player.made.counted("CLOUD/too_few_lines"), 1);
  EXPECT_EQ(player.made.clouds.size(), before + 1);
}

TEST(CloudAssembler, SliceEndsAtAHole) {
  const ScannerRig rig;
  Player player(rig, standing_config(rig));
  player.play(0, 3);
  player.play(20, 5);
  ASSERT_EQ(player.made.slices.size(), 2u);
  EXPECT_EQ(player.made.slices[0].utime_us,
            rig.line_utime_us(2) + std::llround(kLaserTurn_us / 2.0));
}

TEST(CloudAssembler, SkipsLinesThatComeOutOfOrderButNotTimeThatStartsAnew) {
  const ScannerRig rig;
  Player player(rig, standing_config(rig));
  player.play(0, 100);
  player.line(98);
  player.line(99);
  EXPECT_EQ(player.made.counted("LASER/out_of_order"), 2);
  const std::size_t before = player.made.clouds.size();
  player.play(0, 100);
  EXPECT_EQ(player.made.counted("LASER/time_started_anew"), 1);
  EXPECT_GT(player.made.clouds.size(), before);
}

TEST(CloudAssembler, OneSidedMirrorGivesACloudEverySecondHalfTurn) {
  const ScannerRig rig;
  CloudAssemblerConfig config = standing_config(rig);
  config.mirror_sides = 1;
  const Made made = play(rig, config, 6.0);
  EXPECT_EQ(made.clouds.size(), 3u);
  EXPECT_NEAR(static_cast<double>(made.counted("LASER/dead_side")), 225.0, 10.0);
  for (const Cloud& cloud : made.clouds) EXPECT_LT(rms_error_m(rig, cloud), 0.001);
}

TEST(CloudAssembler, LeavesOutTheBlindWedge) {
  ScannerRig rig;
  const auto widest_deg = [&rig](std::vector<double> blind_phi_deg) {
    CloudAssemblerConfig config = standing_config(rig);
    config.blind_phi_deg = std::move(blind_phi_deg);
    double nearest_deg = 180.0;
    const Made made = play(rig, config, 2.1);
    for (const auto& point : made.clouds.at(1).points) {
      const double phi_deg =
          std::atan2(-point.x(), point.z() - rig.geometry.mount_z_m) * 180.0 / kPi;
      nearest_deg = std::min(nearest_deg, std::abs(phi_deg));
    }
    return nearest_deg;
  };
  EXPECT_NEAR(widest_deg({-15.0, 15.0}), 15.0, 1.0);
  EXPECT_NEAR(widest_deg({320.0, 400.0}), 40.0, 1.0) << "beyond a whole turn";
}

TEST(CloudAssembler, LeavesOutTheRobotItself) {
  ScannerRig rig;
  CloudAssemblerConfig config = standing_config(rig);
  config.robot_boxes_m = {-0.5, 0.5, -0.4, 0.4, -0.05, 0.3, 2.5, 3.5, -1.0, 1.0, 0.0, 2.0};
  const Made made = play(rig, config, 2.1);
  ASSERT_GE(made.clouds.size(), 2u);
  EXPECT_GT(made.counted("beams/robot"), 100);
  for (const auto& p : made.clouds[1].points) {
    ASSERT_FALSE(std::abs(p.x()) <= 0.5F && std::abs(p.y()) <= 0.4F && p.z() <= 0.3F);
    ASSERT_FALSE(p.x() >= 2.5F && std::abs(p.y()) <= 1.0F && p.z() >= 0.0F && p.z() <= 2.0F);
  }
}

// The fates of one line's beams, whose ranges are what the test says; the mirror throws them down.
Made fates(const CloudAssemblerConfig& config, const std::vector<float>& ranges_from_60_deg) {
  ScannerRig rig;
  rig.psi_0_rad = 1.5 * kPi;
  CloudAssembler assembler(config);
  LaserLine line = rig.line(0);
  line.ranges_m.assign(181, std::numeric_limits<float>::quiet_NaN());
  std::ranges::copy(ranges_from_60_deg, line.ranges_m.begin() + 60);
  Made made;
  made += assembler.add_mirror(rig.mirror(0));
  made += assembler.add_line(line);
  return made;
}

TEST(CloudAssembler, CountsWhatBecameOfEachBeam) {
  CloudAssemblerConfig config;
  config.use_odometry = false;
  config.range_min_m = 0.3;
  config.range_max_m = 5.0;
  // At 60 deg the mirror is 0.113 m away (its surface 2 mm before its axis), at 68 deg 0.106 m.
  const Made made =
      fates(config, {0.05F, 0.11F, 0.15F, 0.40F, 0.45F, 1.0F, 5.05F, 5.15F, INFINITY});
  EXPECT_EQ(made.counted("beams/before_mirror"), 2) << "an arm, and the plate's edge";
  EXPECT_EQ(made.counted("beams/too_near"), 2);
  EXPECT_EQ(made.counted("beams/points"), 3);
  EXPECT_EQ(made.counted("beams/too_far"), 1);
  EXPECT_EQ(made.counted("beams/no_return"), 1);
  EXPECT_EQ(made.counted("beams/off_mirror"), 50);
  EXPECT_EQ(made.counted("beams/no_measurement"), 131 - 9);
}

TEST(CloudAssembler, MirrorThatStandsFillsNoMemory) {
  const ScannerRig rig;
  CloudAssembler assembler(standing_config(rig));
  LaserLine line = rig.line(20);
  MirrorState standing = rig.mirror(20);
  standing.rate_radps = 0.0;
  standing.step_rad = 0.0;
  Made made;
  for (int i = 0; i < 8'000; ++i) {
    line.utime_us += 13'333;
    standing.utime_us += 13'333;
    made.named.clear();
    made += assembler.add_mirror(standing);
    made += assembler.add_line(line);
    made.slices.clear();
    if (made.counted("CLOUD/too_long") > 0) break;
  }
  EXPECT_EQ(made.counted("CLOUD/too_long"), 1);
  EXPECT_TRUE(made.clouds.empty());
}

TEST(CloudAssembler, RefusesSettingsThatDoNotFitTogether) {
  const auto refused = [](auto change) {
    CloudAssemblerConfig config;
    change(config);
    try {
      CloudAssembler assembler(config);
    } catch (const std::invalid_argument&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused([](CloudAssemblerConfig&) {}));
  EXPECT_TRUE(refused([](CloudAssemblerConfig& c) { c.blind_phi_deg = {10.0}; }));
  EXPECT_TRUE(refused([](CloudAssemblerConfig& c) { c.blind_phi_deg = {10.0, 5.0}; }));
  EXPECT_TRUE(refused([](CloudAssemblerConfig& c) { c.robot_boxes_m = {0, 1, 0, 1, 0}; }));
  EXPECT_TRUE(refused([](CloudAssemblerConfig& c) { c.robot_boxes_m = {0, 1, 0, 1, 1, 0}; }));
  EXPECT_TRUE(refused([](CloudAssemblerConfig& c) { c.range_min_m = 90.0; }));
  EXPECT_TRUE(refused([](CloudAssemblerConfig& c) { c.beam_first_deg = 160.0; }));
  EXPECT_TRUE(refused([](CloudAssemblerConfig& c) {
    c.mirror_sides = 1;
    c.sweep_boundary_deg = 90.0;
  }));
}

}  // namespace
}  // namespace voxlist::scanner
