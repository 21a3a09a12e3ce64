#include "voxlist/matching/search/overlap_peak.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/matching/synthetic_room.h"
#include "voxlist/matching/search/global_search.h"

namespace voxlist::matching {
namespace {

constexpr double kCell_m = 0.04, kReach_m = 12.0;

TEST(OverlapPeak, ItsMiddleIsNearerToTheTruthThanTheBestOfTheLattice) {
  double best_m = 0.0, best_rad = 0.0, middle_m = 0.0, middle_rad = 0.0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Pose2 truth{2.5 + 0.013 * seed, 2.0 - 0.017 * seed, 0.7 * seed};
    const auto room = synthetic_room(6.0, 5.0, truth, 3000, seed);
    // The walls stand on the lower sides of their cells, and are counted in the cells' middles.
    const Pose2 counted{truth.x_m + kCell_m / 2, truth.y_m + kCell_m / 2, truth.yaw_rad};
    const GlobalMap map(room.map, kCell_m, kReach_m);
    const Cloud cloud{0, room.scan, {}};
    const auto points = map.choose_points(PreparedScan(cloud), 500);
    const SearchResult found = global_search(map, points, {});
    ASSERT_FALSE(found.modes.empty()) << "seed " << seed;
    const Pose2 best = found.modes[0].pose, middle = middle_of_peak(map.dilated(), points, best);
    EXPECT_LT(distance_m(middle, counted), 0.02) << "seed " << seed;
    EXPECT_LT(turn_rad(middle, truth), 0.005) << "seed " << seed;
    best_m += distance_m(best, counted), best_rad += turn_rad(best, truth);
    middle_m += distance_m(middle, counted), middle_rad += turn_rad(middle, truth);
  }
  EXPECT_LT(middle_m, 0.7 * best_m);
  EXPECT_LT(middle_rad, 0.7 * best_rad);
}

TEST(OverlapPeak, IsWhereThePoseWasWhenNothingOverlaps) {
  VoxelMap map(kFinestResolution_m);
  map.insert({0, 0, 0});
  const DilatedMap dilated(map, kCell_m, kReach_m);
  const std::vector<Eigen::Vector3f> points{{2.0F, 0.0F, 0.0F}};
  const Pose2 pose{0.04, 0.08, std::numbers::pi / 2.0};
  EXPECT_EQ(middle_of_peak(dilated, points, pose), pose);
  EXPECT_EQ(middle_of_peak(dilated, {}, pose), pose);
}

}  // namespace
}  // namespace voxlist::matching
