// Along a corridor, surfaces hold nothing, and what stands there tells all the same.
#include "voxlist/matching/engines/along_way.h"

#include <gtest/gtest.h>

#include "tests/simulation/sphere_scan.h"
#include "voxlist/matching/scan/prepared_scan.h"
#include "voxlist/simulation/building/floor_plan.h"
#include "voxlist/simulation/world/world.h"
#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {
namespace {

// No slip of the tests leads to where a scan was taken: rings hit the same spots again there.
constexpr double kMapped_m[] = {-1.5, -1.0, -0.5, 0.0}, kTrue_m = 0.45;
const Eigen::Vector2d kReach(0.4, 0.0);

// A corridor of 2 x 2.6 m, and in the second one lockers along its walls.
simulation::Building corridor(bool with_lockers) {
  std::vector<simulation::Box> boxes{simulation::block({-50.0, -2.0, -0.2}, {50.0, 2.0, 0.0}),
                                     simulation::block({-50.0, -2.0, 2.6}, {50.0, 2.0, 2.8}),
                                     simulation::block({-50.0, -1.2, 0.0}, {50.0, -1.0, 2.6}),
                                     simulation::block({-50.0, 1.0, 0.0}, {50.0, 1.2, 2.6})};
  for (double x = -8.0; with_lockers && x < 8.0; x += 2.7)
    boxes.push_back(simulation::block({x, 0.5, 0.0}, {x + 0.5, 1.0, 2.0}));
  return {simulation::BoxTree(std::move(boxes)), {}, {}};
}

class Corridor : public testing::Test {
 protected:
  explicit Corridor(bool with_lockers) : world_(corridor(with_lockers)) {
    std::uint64_t seed = 1;
    for (const double x_m : kMapped_m)
      add_scan(scan_at(x_m, seed++), to_pose3(Pose2{x_m, 0.0, 0.0}), 100.0, map_);
  }

  Cloud scan_at(double x_m, std::uint64_t seed) const {
    const simulation::SphereScanConfig config{
        .rays = 16 * 360, .rings = 16, .rings_to_deg = 15.0, .height_m = 1.0, .range_max_m = 30.0};
    return scan_sphere(world_, {x_m, 0.0, 0.0}, config, seed);
  }

  std::optional<PlaceOnLine> better_than(double x_m, double true_x_m) const {
    const Cloud cloud = scan_at(true_x_m, 100);
    const PreparedScan scan(cloud);
    const EvidenceMap evidence(map_);
    const SurfelMap surfels(map_);
    const Pose2 pose{x_m, 0.0, 0.0};
    return better_along(evidence, surfels, scan.few_rays(), pose,
                        evidence.on_surfaces(pose, scan.few_rays(), surfels), kReach);
  }

  const simulation::World world_;
  OccupancyMap map_;
};

struct BetterPlaceBetweenLockers : Corridor {
  BetterPlaceBetweenLockers() : Corridor(true) {}
};
struct BetterPlaceInABareCorridor : Corridor {
  BetterPlaceInABareCorridor() : Corridor(false) {}
};

// Wheels that spin measure too long a way.
TEST_F(BetterPlaceBetweenLockers, IsTheTrueOne) {
  const auto better = better_than(kTrue_m + 0.25, kTrue_m);
  ASSERT_TRUE(better);
  EXPECT_NEAR(better->pose.x_m, kTrue_m, 0.1);
  EXPECT_GE(better->sigma_m, 0.05);
  EXPECT_LE(better->sigma_m, 0.15);
}

TEST_F(BetterPlaceBetweenLockers, IsNoneThanTheTrueOne) {
  EXPECT_FALSE(better_than(kTrue_m, kTrue_m));
}

TEST_F(BetterPlaceInABareCorridor, IsNoneThanAnyOther) {
  for (const double slip_m : {-0.25, 0.0, 0.25})
    EXPECT_FALSE(better_than(kTrue_m + slip_m, kTrue_m));
}

}  // namespace
}  // namespace voxlist::matching
