#include "voxlist/simulation/world/people.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "voxlist/simulation/world/robot.h"
#include "voxlist/simulation/world/tour.h"
#include "voxlist/simulation/world/world.h"

namespace voxlist::simulation {
namespace {

struct Scene {
  Building building = make_building({});
  Trajectory robot = drive(plan_tour(building, {}), {});

  std::vector<Trajectory> people(int count, std::uint64_t seed = 1) const {
    return walk(building, robot, 0.0, {count, 1.0}, seed);
  }
};

TEST(People, WalkAtTheirSpeedForAsLongAsTheRobotDrives) {
  const Scene scene;
  const auto people = scene.people(4);
  ASSERT_EQ(people.size(), 4u);
  for (const Trajectory& person : people) {
    EXPECT_GE(person.duration_s(), scene.robot.duration_s());
    double way = 0.0;
    for (double t = 1.0; t < 61.0; t += 0.1) {
      const double step = distance_m(person.at(t), person.at(t + 0.1));
      ASSERT_LE(step, 0.1 + 1e-9);
      way += step;
    }
    EXPECT_GT(way, 50.0);
  }
}

TEST(People, WalkThroughNothingThatStands) {
  const Scene scene;
  for (const Trajectory& person : scene.people(4))
    for (double t = 0.0; t < person.duration_s(); t += 0.5) {
      const Pose2 pose = person.at(t);
      ASSERT_GE(scene.building.clearance_m({pose.x_m, pose.y_m}, 0.02, 1.75), 0.2) << t;
    }
}

TEST(People, KeepOutOfTheRobotsWay) {
  const Scene scene;
  for (const Trajectory& person : scene.people(6))
    for (double t = 0.0; t < scene.robot.duration_s(); t += 0.1)
      ASSERT_GE(distance_m(person.at(t), scene.robot.at(t)), 0.45) << t;
}

TEST(People, WalkTheSameForASeedAndOtherwiseForAnother) {
  const Scene scene;
  EXPECT_EQ(scene.people(2)[1].poses(), scene.people(2)[1].poses());
  EXPECT_EQ(scene.people(2)[0].poses(), scene.people(1)[0].poses());
  EXPECT_NE(scene.people(2)[1].poses(), scene.people(2, 2)[1].poses());
}

TEST(People, StandInTheWorldWhereTheyAreAtATime) {
  const Scene scene;
  const auto people = scene.people(1);
  const World empty(scene.building), world(scene.building, people);
  for (const double t : {3.0, 30.0}) {
    const Pose2 at = people[0].at(t);
    const Eigen::Vector3d above(at.x_m, at.y_m, 2.3);
    EXPECT_NEAR(*world.range(above, -Eigen::Vector3d::UnitZ(), t), 2.3 - 1.75, 1e-9);
    EXPECT_NEAR(*world.range(above, -Eigen::Vector3d::UnitZ(), t + 5.0),
                *empty.range(above, -Eigen::Vector3d::UnitZ(), t), 1e-9);
  }
}

}  // namespace
}  // namespace voxlist::simulation
