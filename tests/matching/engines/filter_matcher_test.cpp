// The paper's filter as an engine: which modes it gives.
#include "voxlist/matching/engines/filter_matcher.h"

#include <gtest/gtest.h>

#include "tests/matching/synthetic_room.h"

namespace voxlist::matching {
namespace {

constexpr double kApart_m = 8.0;
const Pose2 kTruth{2.5, 1.7, 0.4}, kTwin{kTruth.x_m + kApart_m, kTruth.y_m, kTruth.yaw_rad};

RoomSurfaces room() { return RoomSurfaces(5.0, 3.5, 6, 1); }

// Two rooms that are alike in all.
OccupancyMap two_rooms() {
  OccupancyMap map;
  for (const double x_m : {0.0, kApart_m})
    room().sample(0.02, [&](const Eigen::Vector3d& p) {
      map.occupied.insert(
          voxel_at(Eigen::Vector3d(p.x() + x_m, p.y(), p.z()), kFinestResolution_m));
    });
  return map;
}

Cloud scan() {
  Cloud cloud;
  room().sample(0.1, [&](const Eigen::Vector3d& p) {
    cloud.points.push_back((kTruth.inverse() * p).cast<float>());
  });
  return cloud;
}

bool is_at(const MatchMode& mode, const Pose2& pose) {
  return distance_m(mode.pose, pose) < 0.03 && turn_rad(mode.pose, pose) < 0.01;
}

TEST(FilterMatcher, FindsTheBestPoseOfItsWindowAndRefinesIt) {
  const OccupancyMap map = two_rooms();
  const auto matcher = make_filter_matcher(map, {});
  const PoseWindow window{kTwin * Pose2{0.15, -0.1, 0.05}, 0.3, 0.3, 0.15};
  const Cloud cloud = scan();
  const Match match = matcher->match(PreparedScan(cloud), window);
  ASSERT_FALSE(match.modes.empty());
  const MatchMode& best = match.modes.front();
  EXPECT_TRUE(is_at(best, kTwin));
  EXPECT_NE(best.pose, best.start);
  EXPECT_GT(best.inlier_ratio, 0.5);
  EXPECT_GT(best.support, 0.8);
  EXPECT_GT(best.overlap_ratio, 0.5);
  EXPECT_TRUE(match.complete);
  EXPECT_GT(match.poses_examined, 100);
}

TEST(FilterMatcher, ListsBothOfTwoPlacesThatAreAlike) {
  const OccupancyMap map = two_rooms();
  const auto matcher = make_filter_matcher(map, {});
  const PoseWindow both{
      {kTruth.x_m + kApart_m / 2, kTruth.y_m, kTruth.yaw_rad}, kApart_m / 2 + 0.2, 0.2, 0.15};
  const Cloud cloud = scan();
  const Match match = matcher->match(PreparedScan(cloud), both);
  ASSERT_GE(match.modes.size(), 2U);
  EXPECT_LE(match.modes.size(), 8U);
  for (const Pose2& place : {kTruth, kTwin})
    EXPECT_TRUE(is_at(match.modes[0], place) || is_at(match.modes[1], place)) << place.x_m;
  for (std::size_t i = 1; i < match.modes.size(); ++i) {
    EXPECT_LE(match.modes[i].support, match.modes[i - 1].support) << i;
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_FALSE(is_at(match.modes[i], match.modes[j].pose)) << i << ' ' << j;
  }
}

// What either engine leaves unlisted is the same share: the default has one home.
TEST(FilterMatcher, LeavesNoMoreUnseenThanTheSearch) {
  const OccupancyMap map = two_rooms();
  const Cloud cloud = scan();
  const Match search = make_matcher(map, {})->match(PreparedScan(cloud), std::nullopt);
  const Match filter =
      make_filter_matcher(map, {})->match(PreparedScan(cloud), PoseWindow{kTruth, 0.2, 0.2, 0.1});
  ASSERT_TRUE(search.complete && filter.complete);
  EXPECT_LT(search.unseen, 1.0);
  EXPECT_EQ(filter.unseen, search.unseen);
}

TEST(FilterMatcher, FindsNothingOfAHandfulOfPoints) {
  const OccupancyMap map = two_rooms();
  Cloud few = scan();
  few.points.resize(20);
  const Match match =
      make_filter_matcher(map, {})->match(PreparedScan(few), PoseWindow{kTruth, 0.2, 0.2, 0.1});
  EXPECT_TRUE(match.modes.empty());
  EXPECT_FALSE(match.complete);
  EXPECT_EQ(match.unseen, 1.0);
}

}  // namespace
}  // namespace voxlist::matching
