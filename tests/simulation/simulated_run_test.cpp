#include "simulation/simulated_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <variant>
#include <vector>

namespace voxlist {
namespace {

SimulationConfig five_seconds() {
  SimulationConfig config;
  config.duration_s = 5.0;
  return config;
}

struct Recording {
  std::vector<StampedPose2> odometry, truth;
  std::vector<Cloud> clouds;
  std::vector<std::int64_t> utimes_us;
};

Recording record(const SimulationConfig& config) {
  Recording recording;
  SimulatedRun run(config);
  while (const auto event = run.next()) {
    if (const auto* odometry = std::get_if<SimulatedOdometry>(&*event)) {
      recording.odometry.push_back(odometry->measured);
      recording.utimes_us.push_back(odometry->measured.utime_us);
    } else if (const auto* truth = std::get_if<SimulatedTruth>(&*event)) {
      recording.truth.push_back(truth->pose);
      recording.utimes_us.push_back(truth->pose.utime_us);
    } else {
      recording.clouds.push_back(std::get<Cloud>(*event));
      recording.utimes_us.push_back(recording.clouds.back().utime_us);
    }
  }
  return recording;
}

TEST(SimulatedRun, YieldsEveryEventOfItsDurationInTheOrderOfTime) {
  const Recording run = record(five_seconds());
  EXPECT_EQ(run.odometry.size(), 251u);
  EXPECT_EQ(run.truth.size(), 5u);
  ASSERT_EQ(run.clouds.size(), 5u);
  EXPECT_EQ(run.clouds.front().utime_us, 1'000'000);
  EXPECT_EQ(run.clouds.back().utime_us, 5'000'000);
  EXPECT_TRUE(std::is_sorted(run.utimes_us.begin(), run.utimes_us.end()));
}

TEST(SimulatedRun, TellsTheMotionOfASweepBeforeTheSweep) {
  SimulatedRun run(five_seconds());
  std::int64_t odometry_us = -1, truth_us = -1;
  while (const auto event = run.next()) {
    if (const auto* odometry = std::get_if<SimulatedOdometry>(&*event))
      odometry_us = odometry->measured.utime_us;
    if (const auto* truth = std::get_if<SimulatedTruth>(&*event)) truth_us = truth->pose.utime_us;
    if (const auto* cloud = std::get_if<Cloud>(&*event)) {
      EXPECT_EQ(odometry_us, cloud->utime_us);
      EXPECT_EQ(truth_us, cloud->utime_us);
    }
  }
}

TEST(SimulatedRun, StartsAtTheIdentityAndGoesSomewhere) {
  const Recording run = record(five_seconds());
  EXPECT_EQ(run.odometry.front().pose, Pose2{});
  EXPECT_GT(distance_m(run.truth.back().pose, {}), 0.5);
}

TEST(SimulatedRun, GivesTheSameBitsForASeed) {
  SimulationConfig config = five_seconds();
  const Recording first = record(config), second = record(config);
  config.seed = 2;
  const Recording other = record(config);
  for (std::size_t i = 0; i < first.odometry.size(); ++i)
    ASSERT_EQ(first.odometry[i].pose, second.odometry[i].pose);
  for (std::size_t i = 0; i < first.clouds.size(); ++i)
    ASSERT_EQ(first.clouds[i].points, second.clouds[i].points);
  EXPECT_NE(first.odometry.back().pose, other.odometry.back().pose);
  EXPECT_EQ(first.truth.back().pose, other.truth.back().pose);
  EXPECT_NE(first.clouds.back().points, other.clouds.back().points);
}

TEST(SimulatedRun, LastsUntilTheTourIsOverUnlessToldOtherwise) {
  const SimulatedRun run(SimulationConfig{});
  EXPECT_EQ(run.duration_s(), run.truth().duration_s());
  EXPECT_GT(run.duration_s(), 60.0);
}

}  // namespace
}  // namespace voxlist
