#include "voxlist/matching/localisation/localiser.h"

#include <gtest/gtest.h>

#include <variant>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/tilt.h"
#include "voxlist/simulation/run/simulated_run.h"

namespace voxlist::matching {
namespace {

// What a robot saw in the building of a seed, with the truth and the odometry of each cloud.
struct Drive {
  std::vector<Cloud> clouds;
  std::vector<Pose2> truth, odometry;
};

Drive drive(int seed, double duration_s) {
  simulation::SimulationConfig config;
  config.seed = seed;
  config.building.seed = seed;
  config.duration_s = duration_s;
  simulation::SimulatedRun run(config);
  Drive drive;
  Pose2 truth, odometry;
  while (const auto event = run.next()) {
    if (const auto* t = std::get_if<simulation::SimulatedTruth>(&*event)) truth = t->pose.pose;
    if (const auto* o = std::get_if<simulation::SimulatedOdometry>(&*event))
      odometry = o->measured.pose;
    if (const auto* cloud = std::get_if<Cloud>(&*event)) {
      drive.clouds.push_back(*cloud);
      drive.truth.push_back(truth);
      drive.odometry.push_back(odometry);
    }
  }
  return drive;
}

void add(OccupancyMap& map, const Cloud& cloud, const Pose2& pose) {
  add_scan(cloud, to_pose3(pose), 100.0, map);
}

OccupancyMap map_at_truth(const Drive& drive) {
  OccupancyMap map;
  for (std::size_t i = 0; i < drive.clouds.size(); ++i) add(map, drive.clouds[i], drive.truth[i]);
  return map;
}

TEST(Localiser, FirstCloudDefinesTheMapFrame) {
  OccupancyMap map;
  Localiser localiser(map);
  const Drive run = drive(1, 1.0);
  const auto result = localiser.localise(run.clouds[0]);
  EXPECT_TRUE(result.tracking());
  EXPECT_EQ(result.modes.at(0).T_map_base, Pose2{});
  EXPECT_EQ(localiser.localise(Cloud{}).state, LocalisationState::kLost);
}

TEST(Localiser, ClaimsNoPoseOfACloudWhoseFloorLeans) {
  const Drive run = drive(1, 2.0);
  const OccupancyMap map = map_at_truth(run);
  Localiser localiser(map);
  ASSERT_TRUE(localiser.localise(run.clouds[0]).tracking());
  const Tilt mount{0.0, 0.0, 10.0 * kRadPerDeg};
  const Cloud tilted = moved(to_level(mount), run.clouds[1]);
  const Localisation found = localiser.localise(tilted);
  EXPECT_EQ(found.state, LocalisationState::kLost);
  ASSERT_TRUE(found.floor);
  EXPECT_NEAR(found.floor->lean_rad(), mount.pitch_rad, 0.5 * kRadPerDeg);
  EXPECT_FALSE(localiser.locate(tilted).tracking());
  const OccupancyMap none;
  EXPECT_FALSE(Localiser(none).localise(tilted).tracking()) << "it begins no map";
  EXPECT_TRUE(localiser.localise(run.clouds[1]).tracking()) << "it costs itself alone";
}

TEST(Localiser, ClaimsNothingFromAHandfulOfPoints) {
  const Drive run = drive(1, 2.0);
  Cloud few = run.clouds[1];
  few.points.resize(40);
  few.origins.clear();
  OccupancyMap empty;
  EXPECT_FALSE(Localiser(empty).localise(few).tracking());
  const OccupancyMap map = map_at_truth(run);
  Localiser localiser(map);
  EXPECT_FALSE(localiser.localise(few).tracking());
}

TEST(Localiser, TakesAHintOnlyWhileNoScanSaysWhereItIs) {
  const Drive run = drive(1, 2.0);
  const UncertainPose there{run.truth[0], Eigen::Vector3d(0.25, 0.25, 0.07).asDiagonal()};
  const OccupancyMap none, map = map_at_truth(run);
  EXPECT_FALSE(Localiser(none).hint(there));
  Localiser localiser(map);
  EXPECT_TRUE(localiser.hint(there));
  ASSERT_TRUE(localiser.localise(run.clouds[0]).tracking());
  EXPECT_FALSE(localiser.hint(there));
}

TEST(Localiser, FindsTheSamePlaceWhetherAHintIsTrueOrFalse) {
  const Drive run = drive(1, 2.0);
  const OccupancyMap map = map_at_truth(run);
  for (const double off_m : {0.5, 30.0}) {
    Localiser localiser(map);
    ASSERT_TRUE(localiser.hint({{run.truth[1].x_m + off_m, run.truth[1].y_m, run.truth[1].yaw_rad},
                                Eigen::Vector3d(0.25, 0.25, 0.07).asDiagonal()}));
    const Localisation found = localiser.localise(run.clouds[1]);
    ASSERT_TRUE(found.tracking());
    EXPECT_LT(distance_m(found.modes.front().T_map_base, run.truth[1]), 0.05);
  }
}

// Maps scan by scan, and returns the largest error of a pose.
double largest_mapping_error_m(const Drive& run, bool with_odometry) {
  OccupancyMap map;
  Localiser localiser(map);
  double worst = 0.0;
  for (std::size_t i = 0; i < run.clouds.size(); ++i) {
    const auto result = localiser.localise(
        run.clouds[i], with_odometry ? std::optional(run.odometry[i]) : std::nullopt);
    if (!result.tracking()) return 1e9;
    const Pose2& pose = result.modes.front().T_map_base;
    worst = std::max(worst, distance_m(pose, run.truth[0].inverse() * run.truth[i]));
    add(map, run.clouds[i], pose);
  }
  return worst;
}

TEST(Localiser, TracksWhileItsMapGrows) {
  const Drive run = drive(1, 25.0);
  EXPECT_LT(largest_mapping_error_m(run, false), 0.15);
  EXPECT_LT(largest_mapping_error_m(run, true), 0.15);
}

TEST(Localiser, IsAsSureAfterBlindScansAsBeforeThem) {
  const Drive run = drive(1, 6.0);
  OccupancyMap map, same;
  Localiser localiser(map), other(same);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto found = localiser.localise(run.clouds[i], run.odometry[i]);
    ASSERT_TRUE(found.tracking());
    ASSERT_TRUE(other.localise(run.clouds[i], run.odometry[i]).tracking());
    add(map, run.clouds[i], found.modes.front().T_map_base);
    add(same, run.clouds[i], found.modes.front().T_map_base);
  }
  for (int i = 0; i < 20; ++i) {
    Cloud blind;
    blind.utime_us = run.clouds[3].utime_us + 10'000 * (i + 1);
    EXPECT_EQ(other.localise(blind, run.odometry[3]).state, LocalisationState::kLost);
  }
  const auto plain = localiser.localise(run.clouds[4], run.odometry[4]),
             after = other.localise(run.clouds[4], run.odometry[4]);
  EXPECT_TRUE(after.tracking());
  EXPECT_EQ(after.confidence, plain.confidence);
}

TEST(Localiser, SaysThatOdometryDisagreesWhereWallsTellAndWheelsSlip) {
  const Drive run = drive(4, 14.0);
  const OccupancyMap map = map_at_truth(run);
  Localiser localiser(map);
  const Pose2 slip{0.4, 0.0, 0.0};  // while the robot drives from cloud 6 to 7
  for (std::size_t i = 0; i < 9; ++i) {
    const auto found =
        localiser.localise(run.clouds[i], i < 7 ? run.odometry[i] : slip * run.odometry[i]);
    ASSERT_TRUE(found.tracking()) << i;
    EXPECT_LT(distance_m(found.modes.front().T_map_base, run.truth[i]), 0.1) << i;
    if (i < 5) continue;
    ASSERT_TRUE(found.odometry_error) << i;
    EXPECT_EQ(found.odometry_error->disagrees(), i == 8) << i;
    EXPECT_NEAR(found.odometry_error->distance_m, i == 8 ? 0.4 : 0.0, 0.1) << i;
  }
}

TEST(Localiser, FindsScansInTheWholeMapOrSaysThatItIsNotSure) {
  const Drive run = drive(2, 40.0);
  const OccupancyMap map = map_at_truth(run);
  Localiser localiser(map);
  int sure = 0;
  for (std::size_t i = 1; i < run.clouds.size(); i += 4) {
    const auto result = localiser.locate(run.clouds[i]);
    EXPECT_TRUE(result.searched_whole_map);
    if (!result.tracking()) continue;
    ++sure;
    EXPECT_LT(distance_m(result.modes.front().T_map_base, run.truth[i]), 0.1) << "scan " << i;
    EXPECT_GE(result.confidence, 0.9);
  }
  EXPECT_GE(sure, 4);
}

TEST(Localiser, IsNotSureOfAScanOfAnotherBuilding) {
  const Drive own = drive(3, 40.0), other = drive(1003, 20.0);
  const OccupancyMap map = map_at_truth(own);
  Localiser localiser(map);
  EXPECT_TRUE(localiser.locate(own.clouds.at(20)).tracking());
  ASSERT_GE(other.clouds.size(), 15U);
  for (std::size_t i = 0; i < other.clouds.size(); i += 5) {
    EXPECT_FALSE(localiser.locate(other.clouds[i]).tracking()) << "scan " << i;
  }
}

TEST(Localiser, SearchesTheWholeMapAfterItHasForgotten) {
  const Drive run = drive(4, 30.0);
  const OccupancyMap map = map_at_truth(run);
  Localiser localiser(map);
  std::size_t i = 0;
  while (!localiser.localise(run.clouds[i]).tracking()) ASSERT_LT(++i, run.clouds.size());
  EXPECT_FALSE(localiser.localise(run.clouds[i]).searched_whole_map);
  localiser.forget();
  EXPECT_TRUE(localiser.localise(run.clouds[i]).searched_whole_map);
}

TEST(Localiser, SaysHowSureItIsWhileItTracks) {
  const Drive run = drive(4, 30.0);
  const OccupancyMap map = map_at_truth(run);
  Localiser localiser(map);
  int tracked = 0;
  for (std::size_t i = 0; i < run.clouds.size(); ++i) {
    const Localisation result = localiser.localise(run.clouds[i], run.odometry[i]);
    if (!result.tracking() || result.searched_whole_map) continue;
    ++tracked;
    EXPECT_GT(result.confidence, 0.9) << i;
    EXPECT_LT(result.confidence, 1.0) << i;
    double sum = 0.0;
    for (const PoseMode& mode : result.modes) sum += mode.probability;
    EXPECT_EQ(result.modes.at(0).probability, result.confidence) << i;
    EXPECT_LE(sum, 1.0) << i;
  }
  EXPECT_GE(tracked, 20);
}

TEST(Localiser, NoticesThatItWasCarriedElsewhere) {
  const Drive run = drive(6, 60.0);
  const OccupancyMap map = map_at_truth(run);
  int carried = 0;
  for (std::size_t from = 0; from + 3 < run.clouds.size(); from += 10) {
    for (std::size_t to = 0; to < run.clouds.size(); to += 20) {
      if (distance_m(run.truth[from + 3], run.truth[to]) < 3.0) continue;
      Localiser localiser(map);
      Localisation result;
      for (std::size_t i = from; i < from + 3; ++i)
        result = localiser.localise(run.clouds[i], run.odometry[i]);
      if (!result.tracking()) continue;
      ++carried;
      // The wheels have felt nothing.
      result = localiser.localise(run.clouds[to], run.odometry[from + 2]);
      if (result.tracking()) {
        EXPECT_LT(distance_m(result.modes.front().T_map_base, run.truth[to]), 0.1)
            << "from scan " << from << " to scan " << to;
      }
    }
  }
  EXPECT_GE(carried, 5);
}

TEST(Localiser, GivesEachModeItsProbability) {
  const Drive run = drive(2, 30.0);
  const OccupancyMap map = map_at_truth(run);
  Localiser localiser(map);
  const auto result = localiser.locate(run.clouds[10]);
  double sum = 0.0, last = 1.0;
  for (const PoseMode& mode : result.modes) {
    EXPECT_LE(mode.probability, last);
    sum += last = mode.probability;
  }
  ASSERT_FALSE(result.modes.empty());
  EXPECT_EQ(result.confidence, result.modes.front().probability);
  EXPECT_LT(sum, 1.0);
}

TEST(Localiser, GivesTheSameBitsForAnyNumberOfThreads) {
  const Drive run = drive(5, 12.0);
  const OccupancyMap map = map_at_truth(run);
  std::vector<Localisation> results;
  for (const int threads : {1, 2, 4}) {
    LocaliserConfig config;
    config.threads = threads;
    Localiser localiser(map, config);
    results.push_back(localiser.locate(run.clouds[6]));
  }
  ASSERT_FALSE(results[0].modes.empty());
  for (const auto& result : results) {
    ASSERT_EQ(result.modes.size(), results[0].modes.size());
    for (std::size_t m = 0; m < result.modes.size(); ++m) {
      EXPECT_EQ(result.modes[m].T_map_base, results[0].modes[m].T_map_base);
    }
    EXPECT_EQ(result.confidence, results[0].confidence);
    EXPECT_EQ(result.poses_examined, results[0].poses_examined);
  }
}

TEST(Localiser, RunsThePapersFilterWhenAsked) {
  const Drive run = drive(1, 3.0);
  OccupancyMap map;
  add(map, run.clouds[0], Pose2{});
  LocaliserConfig config;
  config.matcher.engine = Engine::kParticleFilter;
  OccupancyMap empty;
  Localiser localiser(empty, config);
  localiser.localise(run.clouds[0]);
  add(empty, run.clouds[0], Pose2{});
  const auto result = localiser.localise(run.clouds[1]);
  ASSERT_TRUE(result.tracking());
  EXPECT_LT(distance_m(result.modes.front().T_map_base, run.truth[0].inverse() * run.truth[1]),
            0.1);
}

}  // namespace
}  // namespace voxlist::matching
