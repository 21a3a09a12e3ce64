#include "voxlist/scanner/arms/arm_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/scanner/mirror/synthetic_mirror.h"
#include "voxlist/geometry/pose.h"

namespace voxlist::scanner {
namespace {

constexpr std::int64_t kOrigin_us = 1'700'000'000'000'000;

std::vector<ArmPassage> passages(SyntheticMirror& mirror, double end_s) {
  const MirrorClockConfig config = MirrorRun::usual_config();
  ArmDetector detector(config.arms, config.arm_height_max_m);
  std::vector<ArmPassage> found;
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  for (double time_s = 0.0; time_s < end_s; time_s += 1.0 / mirror.line_hz) {
    LaserLine line = mirror.line(time_s);
    line.utime_us = kOrigin_us + std::llround(time_s * 1e6);
    if (chance(mirror.random) < mirror.lost_lines) continue;
    for (const ArmPassage& passage : detector.add(line)) found.push_back(passage);
  }
  return found;
}

double psi_deg(const SyntheticMirror& mirror, std::int64_t utime_us) {
  return mirror.angle_rad(static_cast<double>(utime_us - kOrigin_us) * 1e-6) / kDeg;
}

// Every passage once, with the true ends in its spans.
void expect_all(const SyntheticMirror& mirror, const std::vector<ArmPassage>& found, int expected,
                double slack_deg = 0.02) {
  EXPECT_EQ(found.size(), static_cast<std::size_t>(expected));
  for (const ArmPassage& p : found) {
    const double middle_deg = mirror.arms[p.arm].angle_deg;
    const auto off = [&](std::int64_t utime_us, double from_deg) {
      return wrap_angle((psi_deg(mirror, utime_us) - from_deg) * kDeg) / kDeg;
    };
    EXPECT_LE(off(p.enter.after_us, middle_deg - 5.74), slack_deg);
    EXPECT_GE(off(p.enter.before_us, middle_deg - 5.74), -slack_deg);
    EXPECT_LE(off(p.leave.after_us, middle_deg + 5.74), slack_deg);
    EXPECT_GE(off(p.leave.before_us, middle_deg + 5.74), -slack_deg);
    EXPECT_LE(std::abs(off(p.middle_us(), middle_deg)), 5.0);
  }
}

TEST(ArmDetector, FindsEveryPassageOfEachArmBetweenTheRightBeams) {
  for (const double revolution_s : {1.0, 2.0, 9.6}) {
    SyntheticMirror mirror;
    mirror.revolution_s = revolution_s;
    mirror.room = true;
    expect_all(mirror, passages(mirror, 10.0 * revolution_s), 20);
  }
}

TEST(ArmDetector, SeesTheArmComeWithinALine) {
  SyntheticMirror mirror;
  int sharp = 0;
  for (const ArmPassage& p : passages(mirror, 200.0))
    sharp += p.enter.before_us - p.enter.after_us < 100;
  EXPECT_GT(sharp, 8) << "of 200 passages a tenth begins between two beams of one line";
}

TEST(ArmDetector, IsNotMisledByDazzleLostLinesAndSpuriousReturns) {
  SyntheticMirror mirror;
  mirror.dazzled = 0.2;
  mirror.lost_lines = 0.1;
  mirror.spurious = 0.01;
  // Noise may move an end by a few beams.
  expect_all(mirror, passages(mirror, 60.0), 60, 0.1);
}

TEST(ArmDetector, DoesNotTakeThePlatesEdgeForAnArm) {
  SyntheticMirror mirror;
  mirror.arms[0].there = mirror.arms[1].there = false;
  for (const double line_hz : {74.3, 75.03, 76.1}) {
    mirror.line_hz = line_hz;
    EXPECT_TRUE(passages(mirror, 120.0).empty());
  }
}

TEST(ArmDetector, FindsNothingInBeamsWithoutMeasurement) {
  SyntheticMirror mirror;
  mirror.dazzled = 1.0;
  EXPECT_TRUE(passages(mirror, 10.0).empty());
}

}  // namespace
}  // namespace voxlist::scanner
