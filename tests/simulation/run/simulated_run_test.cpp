#include "voxlist/simulation/run/simulated_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <variant>
#include <vector>

namespace voxlist::simulation {
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

TEST(SimulatedRun, CarriesTheRobotOffAndTheWheelsMeasureNothingOfIt) {
  SimulationConfig config = five_seconds();
  config.carried = {{2.0, 4.0}, {3.0, 1.0}, {0.5, -0.5}, 0.0};
  const Recording run = record(config);
  ASSERT_EQ(run.truth.size(), 5u);
  EXPECT_LT(distance_m(run.truth[1].pose, {}), 1.0) << "it drove until then";
  EXPECT_EQ(run.truth[2].pose, (Pose2{3.0, 0.5, 0.0}));
  EXPECT_EQ(run.truth[4].pose, (Pose2{1.0, -0.5, 0.0}));
  const auto& measured = run.odometry;
  EXPECT_EQ(measured.back().pose, measured[101].pose);
  EXPECT_LT(distance_m(measured.back().pose, run.truth[1].pose), 0.2);
}

TEST(SimulatedRun, DrivesOnWhereTheRobotWasCarriedOff) {
  SimulationConfig config = five_seconds();
  const Recording undisturbed = record(config);
  config.carried = {{2.0}, {30.0}, {0.5}, 4.0};
  config.duration_s = 7.0;
  const Recording run = record(config);
  EXPECT_EQ(run.truth[2].pose, (Pose2{30.0, 0.5, 0.0}));
  EXPECT_LT(distance_m(run.truth.back().pose, undisturbed.truth.back().pose), 0.02);
  EXPECT_LT(distance_m(run.odometry.back().pose, run.truth.back().pose), 0.2);
}

TEST(SimulatedRun, RefusesCarriesWithoutAPlaceOrAnOrder) {
  SimulationConfig config = five_seconds();
  config.carried = {{2.0, 4.0}, {3.0}, {0.5, -0.5}, 0.0};
  EXPECT_THROW(SimulatedRun run(config), std::invalid_argument);
  config.carried = {{4.0, 2.0}, {3.0, 1.0}, {0.5, -0.5}, 0.0};
  EXPECT_THROW(SimulatedRun run(config), std::invalid_argument);
  config.carried = {{2.0}, {3.0}, {0.5}, 1.0};
  EXPECT_THROW(SimulatedRun run(config), std::invalid_argument);
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

// The scanner's own events, with lines.
struct ScannerRecording {
  std::vector<std::int64_t> edges, lines, odometry, truth, all;
  std::vector<std::vector<float>> ranges;
};

ScannerRecording record_scanner(SimulationConfig config) {
  config.scans = SimulationConfig::Scans::kLines;
  ScannerRecording recording;
  SimulatedRun run(config);
  while (const auto event = run.next()) {
    std::vector<std::int64_t>* times = nullptr;
    std::int64_t utime_us = 0;
    if (const auto* edge = std::get_if<SimulatedClockEdge>(&*event)) {
      times = &recording.edges;
      utime_us = edge->utime_us;
    } else if (const auto* line = std::get_if<LaserLine>(&*event)) {
      times = &recording.lines;
      utime_us = line->utime_us;
      recording.ranges.push_back(line->ranges_m);
    } else if (const auto* odometry = std::get_if<SimulatedOdometry>(&*event)) {
      times = &recording.odometry;
      utime_us = odometry->measured.utime_us;
    } else if (const auto* truth = std::get_if<SimulatedTruth>(&*event)) {
      times = &recording.truth;
      utime_us = truth->pose.utime_us;
    }
    times->push_back(utime_us);
    recording.all.push_back(utime_us);
  }
  return recording;
}

TEST(SimulatedRun, YieldsLinesAndTheClocksEdgesInTheOrderOfTime) {
  const ScannerRecording run = record_scanner(five_seconds());
  EXPECT_EQ(run.lines.size(), 376u);  // 75.03 a second
  EXPECT_EQ(run.edges.size(), 1001u);
  EXPECT_EQ(run.edges[77], 385'000);
  EXPECT_EQ(run.odometry.size(), 251u);
  EXPECT_EQ(run.truth, run.odometry);
  EXPECT_TRUE(std::is_sorted(run.all.begin(), run.all.end()));
}

TEST(SimulatedRun, MeasuresTheSameLinesAgain) {
  SimulationConfig config = five_seconds();
  config.people.count = 2;
  config.building.stairs = 1;
  EXPECT_EQ(record_scanner(config).ranges, record_scanner(config).ranges);
}

TEST(SimulatedRun, StampsLinesLateByTheLatencyAndKeepsItsEdges) {
  SimulationConfig config = five_seconds();
  config.latency_ms = 1.0;
  const ScannerRecording late = record_scanner(config);
  const ScannerRecording punctual = record_scanner(five_seconds());
  EXPECT_EQ(late.lines[10], punctual.lines[10] + 1000);
  EXPECT_EQ(late.ranges[10], punctual.ranges[10]);
  EXPECT_EQ(late.edges, punctual.edges);
  EXPECT_TRUE(std::is_sorted(late.all.begin(), late.all.end()));
}

TEST(SimulatedRun, LosesTheClocksEdgesWhileItsLineIsLost) {
  SimulationConfig config = five_seconds();
  config.motor_fault = {.from_s = 1.0, .to_s = 2.0, .clock_lost = true};
  const ScannerRecording run = record_scanner(config);
  EXPECT_EQ(run.edges.size(), 801u);
  EXPECT_EQ(run.edges[200], 2'000'000);
}

TEST(SimulatedRun, StandsInTheMiddleOfTheRoomThatItIsTold) {
  SimulationConfig config;
  config.stand_in_room = 2;
  const SimulatedRun run(config);
  const Eigen::Vector2d centre = run.building().rooms[2].centre();
  EXPECT_EQ(run.truth().at(0.0), (Pose2{centre.x(), centre.y(), 0.0}));
  EXPECT_EQ(run.truth().at(50.0), run.truth().at(0.0));
  EXPECT_EQ(run.duration_s(), 60.0);
  config.stand_in_room = 6;
  EXPECT_THROW(SimulatedRun{config}, std::invalid_argument);
}

TEST(SimulatedRun, HasPerfectWheelsWhenTheirErrorsAreNone) {
  SimulationConfig config;
  config.odometry_errors = 0.0;
  const SimulatedRun run(config);
  EXPECT_LT(distance_m(run.odometry().at(60.0), run.truth().at(60.0)), 1e-6);
}

// Which of three robots, in a building where they can pass each other.
SimulationConfig one_of_three(int robot) {
  SimulationConfig config;
  config.building.length_m = 12.0;
  config.building.depth_m = 12.0;
  config.building.corridor_width_m = 4.0;
  config.share = {3, robot};
  return config;
}

// How often, once a second, a ray from one robot's scanner to the other's middle ends on its body.
int times_seen(const SimulatedRun& one, const SimulatedRun& other) {
  constexpr double kScanner_m = 0.6, kMiddle_m = 0.3, kBody_m = 0.4;
  int times = 0;
  for (double t_s = 0.0; t_s < one.duration_s(); t_s += 1.0) {
    const Pose2 from = one.truth().at(t_s), to = other.truth().at(t_s);
    const Eigen::Vector3d start(from.x_m, from.y_m, kScanner_m), end(to.x_m, to.y_m, kMiddle_m);
    const double distance_m = (end - start).norm();
    const auto range_m = one.world().range(start, (end - start) / distance_m, t_s);
    if (range_m && *range_m<distance_m&& * range_m> distance_m - kBody_m) ++times;
  }
  return times;
}

TEST(SimulatedRun, RobotsThatShareABuildingSeeEachOther) {
  const std::array<SimulatedRun, 3> runs{
      SimulatedRun(one_of_three(0)), SimulatedRun(one_of_three(1)), SimulatedRun(one_of_three(2))};
  for (const SimulatedRun& one : runs)
    for (const SimulatedRun& other : runs)
      EXPECT_TRUE(&one == &other || times_seen(one, other) >= 5);
}

TEST(SimulatedRun, RefusesRobotsThatWouldRunIntoEachOther) {
  SimulationConfig narrow = one_of_three(0);
  narrow.building.corridor_width_m = 1.2;
  EXPECT_THROW(SimulatedRun{narrow}, std::invalid_argument);
  EXPECT_THROW(SimulatedRun{one_of_three(3)}, std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::simulation
