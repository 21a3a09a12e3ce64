#include "voxlist/simulation/scanner/mirror_scanner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace voxlist::simulation {
namespace {

using Eigen::Vector3d;
using Met = SimulatedBeam::Met;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A closed hall of 6 m x 4 m x 3 m around the robot.
Building hall() {
  const auto wall = [](Vector3d centre, Vector3d half) { return Box{centre, half, 0.0}; };
  return {BoxTree({wall({0, 0, -0.1}, {3.2, 2.2, 0.1}), wall({0, 0, 3.1}, {3.2, 2.2, 0.1}),
                   wall({3.1, 0, 1.5}, {0.1, 2.2, 1.5}), wall({-3.1, 0, 1.5}, {0.1, 2.2, 1.5}),
                   wall({0, 2.1, 1.5}, {3.2, 0.1, 1.5}), wall({0, -2.1, 1.5}, {3.2, 0.1, 1.5})}),
          {},
          {}};
}

MirrorScannerConfig exact() {
  MirrorScannerConfig config;
  config.range_sd_m = 0.0;
  return config;
}

struct Scene {
  explicit Scene(const MirrorScannerConfig& config = exact(), std::uint64_t seed = 1)
      : scanner(world, still, config, seed) {}

  SimulatedBeam at(double beam_deg, double psi_deg) const {
    return scanner.trace(0.0, beam_deg * kRadPerDeg, psi_deg * kRadPerDeg);
  }

  World world{hall()};
  Trajectory still{1.0, {Pose2{}}};
  MirrorScanner scanner;
};

TEST(MirrorScanner, SendsItsBeamsLevelToTheWallsByWayOfTheMirror) {
  MirrorScannerConfig config = exact();
  config.mirror.offset_m = {0.0, 0.0};
  const Scene scene(config);
  // phi = 90 deg: to the back; 270 deg: to the front.
  const SimulatedBeam back = scene.at(90.0, 45.0), front = scene.at(90.0, 315.0);
  EXPECT_EQ(back.met, Met::kWorld);
  EXPECT_NEAR(back.range_m, 0.1 + 3.0, 1e-12);
  EXPECT_LT((back.point_base(back.range_m) - Vector3d(-3.0, 0.0, 0.6)).norm(), 1e-12);
  EXPECT_EQ(front.met, Met::kWorld);
  EXPECT_NEAR(front.path_m, 0.1, 1e-12);
  EXPECT_LT((front.point_base(front.range_m) - Vector3d(3.0, 0.0, 0.6)).norm(), 1e-12);
  EXPECT_LT((scene.at(90.0, 225.0).point_base(3.1) - Vector3d(-3.0, 0.0, 0.6)).norm(), 1e-12);
}

TEST(MirrorScanner, EndsEveryReflectedBeamOnAWallWhereverTheMirrorStands) {
  MirrorScannerConfig config = exact();
  config.mirror.phase_deg = {0.25, -0.2};
  config.mirror.axis_yaw_deg = 0.3;
  config.mirror.axis_roll_deg = -0.3;
  config.mirror.flex_deg = 0.2;
  const Scene scene(config);
  int world = 0;
  for (double psi_deg = 0.0; psi_deg < 360.0; psi_deg += 2.0)
    for (double beam_deg = 25.0; beam_deg <= 155.0; beam_deg += 3.0) {
      const SimulatedBeam beam = scene.at(beam_deg, psi_deg);
      if (beam.met != Met::kWorld) continue;
      ++world;
      const Vector3d p = beam.point_base(beam.range_m);
      double nearest = kInfinity;
      for (const Box& box : scene.world.building().solid.boxes())
        nearest = std::min(nearest, box.surface_distance_m(p));
      EXPECT_LT(nearest, 1e-12);
    }
  EXPECT_GT(world, 4000);
}

TEST(MirrorScanner, SeesTheRobotsOwnBodyBelowTheMirror) {
  const Scene scene;
  const SimulatedBeam housing = scene.at(90.0, 270.0);
  EXPECT_EQ(housing.met, Met::kBody);
  EXPECT_NEAR(housing.range_m, 2.0 * 0.098 - 0.01, 1e-9);
  EXPECT_EQ(scene.at(90.0, 270.0 + 20.0).met, Met::kBody);   // 40 deg from straight down
  EXPECT_EQ(scene.at(90.0, 270.0 + 30.0).met, Met::kWorld);  // 60 deg
}

TEST(MirrorScanner, SeesArmsEdgesAndWhatPassesBesideTheMirror) {
  const Scene scene;
  EXPECT_EQ(scene.at(40.0, 90.0).met, Met::kArm);
  EXPECT_FALSE(scene.at(40.0, 90.0).reflected);
  EXPECT_EQ(scene.at(140.0, 265.0).met, Met::kArm);
  EXPECT_EQ(scene.at(90.0, 0.0).met, Met::kEdge);
  EXPECT_NEAR(scene.at(90.0, 0.0).range_m, 0.05, 1e-9);
  const SimulatedBeam passes = scene.at(5.0, 90.0);
  EXPECT_EQ(passes.met, Met::kWorld);
  EXPECT_FALSE(passes.reflected);
  EXPECT_NEAR(passes.range_m, 2.0 / std::cos(5.0 * kRadPerDeg), 1e-12);
}

TEST(MirrorScanner, MeasuresWholeMillimetresUpToItsRange) {
  MirrorScannerConfig config;
  config.range_max_m = 2.5;
  const LaserLine line = Scene(config).scanner.measure(4'000'000);
  ASSERT_EQ(line.ranges_m.size(), 181u);
  int finite = 0, beyond = 0;
  for (const float range : line.ranges_m) {
    if (!std::isfinite(range)) {
      EXPECT_EQ(range, std::numeric_limits<float>::infinity());
      ++beyond;
      continue;
    }
    ++finite;
    EXPECT_NEAR(range * 1e3F, std::round(range * 1e3F), 1e-3F);
    EXPECT_LE(range, 2.5F);
  }
  EXPECT_GT(finite, 50);
  EXPECT_GT(beyond, 20);
}

TEST(MirrorScanner, TracesEachBeamAtItsOwnTime) {
  const Scene scene;
  const LaserLine line = scene.scanner.measure(200'000);
  const double period_s = 1.0 / 360.0 / 75.03;
  for (std::size_t i = 0; i < line.ranges_m.size(); i += 10) {
    const double t_s = 0.2 + static_cast<double>(i) * period_s;
    const double psi = scene.scanner.motor().angle_rad(t_s);
    EXPECT_NEAR(line.ranges_m[i], scene.scanner.trace(t_s, line.angle_rad(i), psi).range_m, 6e-4);
  }
  EXPECT_GT(std::abs(scene.at(100.0, 20.0 + 36.0).range_m - line.ranges_m[100]), 0.01);
}

TEST(MirrorScanner, ShiftsAnInterlacedLineByItsFirstAngleAndKeepsWithinTheFan) {
  const LaserLine line = Scene().scanner.measure(0, 0.25 * kRadPerDeg);
  EXPECT_EQ(line.ranges_m.size(), 180u);
  EXPECT_NEAR(line.angle_rad(179), 179.25 * kRadPerDeg, 1e-12);
}

TEST(MirrorScanner, HasNoiseOfItsDeviationThatFollowsFromSeedAndTimeAlone) {
  MirrorScannerConfig noisy = exact();
  noisy.range_sd_m = 0.02;
  const Scene scene(noisy), same(noisy), other(noisy, 2), without;
  double sum = 0.0, squares = 0.0;
  int count = 0;
  for (std::int64_t t = 0; t < 50; ++t) {
    const LaserLine line = scene.scanner.measure(t * 13'333);
    const LaserLine ideal = without.scanner.measure(t * 13'333);
    for (std::size_t i = 0; i < line.ranges_m.size(); ++i) {
      if (!std::isfinite(line.ranges_m[i]) || ideal.ranges_m[i] < 0.2F) continue;
      const double error = line.ranges_m[i] - ideal.ranges_m[i];
      sum += error;
      squares += error * error;
      ++count;
    }
  }
  EXPECT_GT(count, 5000);
  EXPECT_NEAR(sum / count, 0.0, 0.001);
  EXPECT_NEAR(std::sqrt(squares / count), 0.02, 0.001);
  EXPECT_EQ(scene.scanner.measure(77).ranges_m, same.scanner.measure(77).ranges_m);
  EXPECT_NE(scene.scanner.measure(77).ranges_m, other.scanner.measure(77).ranges_m);
}

TEST(MirrorScanner, StampsItsLinesLateByItsLatency) {
  MirrorScannerConfig late = exact();
  late.latency_s = 0.0015;
  const LaserLine line = Scene(late).scanner.measure(1'000'000);
  EXPECT_EQ(line.utime_us, 1'001'500);
  EXPECT_EQ(line.ranges_m, Scene().scanner.measure(1'000'000).ranges_m);
}

TEST(MirrorScanner, SeesSomeoneWhoWalksWhereTheyAreAtTheBeamsTime) {
  // From y = -1 to 1 m in 10 s, 2 m behind the robot.
  const World world(hall(), {Trajectory(10.0, {{-2.0, -1.0, 1.57}, {-2.0, 1.0, 1.57}})});
  const Trajectory still(1.0, {Pose2{}});
  const MirrorScanner scanner(world, still, exact(), 1);
  const double back = 45.0 * kRadPerDeg, level = 90.0 * kRadPerDeg;
  EXPECT_GT(scanner.trace(0.0, level, back).range_m, 3.0);
  EXPECT_LT(scanner.trace(5.0, level, back).range_m, 2.1);
  EXPECT_GT(scanner.trace(9.0, level, back).range_m, 3.0);
}

}  // namespace
}  // namespace voxlist::simulation
