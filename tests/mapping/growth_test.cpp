#include <gtest/gtest.h>

#include "tests/simulation/sphere_scan.h"
#include "voxlist/mapping/map_builder.h"
#include "voxlist/simulation/random.h"
#include "voxlist/simulation/world/robot.h"
#include "voxlist/simulation/world/tour.h"

namespace voxlist::mapping {
namespace {

// A robot that drives its tour again and again, and offers ten clouds a second at poses that are
// off by 2 mm.
class Laps {
 public:
  explicit Laps(int rooms) : building_(building_of(rooms)), world_(building_) {}

  // Keyframes that one more lap adds.
  std::size_t drive_one() {
    const std::size_t before = builder.poses().size();
    for (double t_s = 0.03 * laps_++; t_s < way_.duration_s(); t_s += 0.1) offer(way_.at(t_s));
    return builder.poses().size() - before;
  }

  MapBuilder builder;

 private:
  static simulation::Building building_of(int rooms) {
    simulation::BuildingConfig config;
    config.rooms = rooms;
    return simulation::make_building(config);
  }

  // Clouds between two looks are not worth making.
  void offer(const Pose2& truth) {
    if (distance_m(truth, last_) < 0.3 && turn_rad(truth, last_) < 0.21) return;
    last_ = truth;
    const Cloud cloud = scan_sphere(world_, truth, {.rays = 10'000, .height_m = 0.8}, ++clouds_);
    const Pose2 pose = truth * Pose2{0.002 * random_.normal(), 0.002 * random_.normal(), 0.0};
    if (builder.wants(cloud, pose)) builder.add({to_pose3(pose), cloud});
  }

  const simulation::Building building_;
  const simulation::World world_;
  const simulation::Trajectory way_ =
      simulation::drive(simulation::plan_tour(building_, {}), simulation::DriveConfig{});
  simulation::Random random_{7};
  Pose2 last_{1e3, 0.0, 0.0};
  std::uint64_t clouds_ = 0;
  int laps_ = 0;
};

TEST(MapGrowth, EndsWhereAllIsKnown) {
  Laps laps(2);
  const std::size_t first = laps.drive_one();
  EXPECT_GT(first, 40u);
  laps.drive_one();
  for (int lap = 2; lap < 4; ++lap) EXPECT_LE(laps.drive_one(), first / 20) << lap;
}

}  // namespace
}  // namespace voxlist::mapping
