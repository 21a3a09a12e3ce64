#include "voxlist/simulation/world/robot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxlist/simulation/world/tour.h"

namespace voxlist::simulation {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

Building building(int seed) {
  BuildingConfig config;
  config.seed = seed;
  return make_building(config);
}

Trajectory tour(const Building& building) { return drive(plan_tour(building, {}), {}); }

// 10 m straight ahead.
Trajectory straight() { return drive({{0.0, 0.0}, {5.0, 0.0}, {10.0, 0.0}}, {}); }

TEST(Robot, VisitsEveryRoomAndEndsWhereItStarted) {
  for (int seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const Building world = building(seed);
    const Trajectory trajectory = tour(world);
    for (const Room& room : world.rooms) {
      const Pose2 centre{room.centre().x(), room.centre().y(), 0.0};
      EXPECT_TRUE(std::any_of(trajectory.poses().begin(), trajectory.poses().end(),
                              [&](const Pose2& pose) { return distance_m(pose, centre) < 0.5; }));
    }
    EXPECT_EQ(trajectory.poses().front(), Pose2{});
    EXPECT_LT(distance_m(trajectory.poses().back(), {}), 0.03);
    EXPECT_LT(turn_rad(trajectory.poses().back(), {}), 0.02);
  }
}

TEST(Robot, NeverTouchesABox) {
  for (int seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const Building world = building(seed);
    const Trajectory trajectory = tour(world);
    for (double t = 0.0; t < trajectory.duration_s(); t += 0.1) {
      const Pose2 pose = trajectory.at(t);
      ASSERT_GE(world.clearance_m({pose.x_m, pose.y_m}, 0.02, 1.0), TourConfig{}.robot_radius_m)
          << "at " << t << " s";
    }
  }
}

TEST(Robot, SeesNothingNearerThanItsOwnRadius) {
  const Building world = building(1);
  const Trajectory trajectory = tour(world);
  for (double t = 0.0; t < trajectory.duration_s(); t += 1.0)
    for (int deg = 0; deg < 360; deg += 5) {
      const Eigen::Vector3d direction{std::cos(deg * kRadPerDeg), std::sin(deg * kRadPerDeg), 0.0};
      for (const double z : {0.1, 0.5, 0.72})
        ASSERT_GE(*world.solid.range(trajectory.at(t) * Eigen::Vector3d(0, 0, z), direction),
                  TourConfig{}.robot_radius_m);
    }
}

TEST(Robot, KeepsItsSpeedsAndMovesOnlyWhereItFaces) {
  const Trajectory trajectory = tour(building(1));
  const double dt = trajectory.period_s();
  const DriveConfig limits;
  double last_speed = 0.0;
  for (std::size_t i = 1; i < trajectory.poses().size(); ++i) {
    const Pose2 step = trajectory.poses()[i - 1].inverse() * trajectory.poses()[i];
    const double speed = step.x_m / dt;
    ASSERT_LE(std::abs(speed), limits.speed_max_mps + 1e-9);
    ASSERT_LE(std::abs(step.yaw_rad) / dt, limits.turn_rate_max_dps * kRadPerDeg + 1e-9);
    ASSERT_LE(std::abs(speed - last_speed), limits.acceleration_max_mps2 * dt + 1e-4);
    ASSERT_NEAR(step.y_m, 0.0, 1e-4);
    last_speed = speed;
  }
}

TEST(Robot, StandsAtItsStartForAsLongAsItIsTold) {
  const Building world = building(1);
  const std::vector<Eigen::Vector2d> path = plan_tour(world, {});
  DriveConfig patient;
  patient.wait_s = 3.0;
  const Trajectory at_once = drive(path, {}), later = drive(path, patient);
  EXPECT_EQ(later.at(3.0), Pose2{});
  for (const double t : {1.0, 10.0, 50.0})
    EXPECT_LT(distance_m(later.at(t + 3.0), at_once.at(t)), 1e-9);
}

TEST(WheelOdometry, IsTheTruthWhenTheWheelsAreRight) {
  const Trajectory truth = tour(building(1));
  const Trajectory measured = wheel_odometry(truth, {50.0, 0.0, 0.0, 0.0, 0.0}, 5);
  for (double t = 0.0; t < truth.duration_s(); t += 1.0) {
    EXPECT_LT(distance_m(truth.at(t), measured.at(t)), 1e-6);
    EXPECT_LT(turn_rad(truth.at(t), measured.at(t)), 1e-6);
  }
}

TEST(WheelOdometry, DriftsAsMuchAsItsErrorsSay) {
  const Trajectory truth = straight();
  const OdometryConfig config;
  const double distance_sd =
      std::hypot(10.0 * config.distance_scale_sd, std::sqrt(10.0) * config.distance_noise_m);
  const double heading_sd = std::sqrt(10.0) * config.heading_noise_deg * kRadPerDeg;
  double distance_squares = 0.0, heading_squares = 0.0;
  constexpr int kSeeds = 100;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    const Trajectory measured = wheel_odometry(truth, config, seed);
    const double along = measured.poses().back().x_m - truth.poses().back().x_m;
    const double heading = measured.poses().back().yaw_rad - truth.poses().back().yaw_rad;
    EXPECT_LT(std::abs(along), 4.0 * distance_sd);
    EXPECT_LT(std::abs(heading), 4.0 * heading_sd);
    distance_squares += along * along;
    heading_squares += heading * heading;
  }
  EXPECT_NEAR(std::sqrt(distance_squares / kSeeds) / distance_sd, 1.0, 0.3);
  EXPECT_NEAR(std::sqrt(heading_squares / kSeeds) / heading_sd, 1.0, 0.3);
}

TEST(Trajectory, TurnsTheShortWayBetweenItsPosesAndHoldsItsEnds) {
  const Trajectory trajectory(2.0, {{0.0, 0.0, 3.0}, {1.0, 2.0, -3.0}});
  EXPECT_NEAR(trajectory.at(1.0).x_m, 0.5, 1e-12);
  EXPECT_NEAR(trajectory.at(1.0).y_m, 1.0, 1e-12);
  EXPECT_NEAR(std::abs(trajectory.at(1.0).yaw_rad), std::numbers::pi, 1e-9);
  EXPECT_EQ(trajectory.at(-1.0), trajectory.poses().front());
  EXPECT_EQ(trajectory.at(9.0), trajectory.poses().back());
}

}  // namespace
}  // namespace voxlist::simulation
