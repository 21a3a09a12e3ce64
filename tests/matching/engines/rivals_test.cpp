#include <gtest/gtest.h>

#include <algorithm>

#include "tests/matching/synthetic_room.h"
#include "voxlist/matching/engines/matcher.h"

namespace voxlist::matching {
namespace {

constexpr double kApart_m = 12.0;

RoomSurfaces room(unsigned seed) { return RoomSurfaces(6.0, 4.0, 6, seed); }

// Two rooms side by side that are alike but for their furniture.
OccupancyMap two_rooms() {
  OccupancyMap map;
  const auto add = [&](unsigned seed, double x_m) {
    room(seed).sample(0.02, [&](const Eigen::Vector3d& p) {
      map.occupied.insert(
          voxel_at(Eigen::Vector3d(p + Eigen::Vector3d(x_m, 0.0, 0.0)), kFinestResolution_m));
    });
  };
  add(1, 0.0);
  add(2, kApart_m);
  return map;
}

Cloud scan_in_first_room(const Pose2& T_map_base) {
  Cloud scan;
  room(1).sample(0.1, [&](const Eigen::Vector3d& p) {
    scan.points.push_back((T_map_base.inverse() * p).cast<float>());
  });
  return scan;
}

TEST(Rivals, AreListedThoughTheyOverlapLess) {
  const OccupancyMap map = two_rooms();
  const auto matcher = make_matcher(map, {});
  const Pose2 truth{2.5, 1.7, 0.4}, rival{truth.x_m + kApart_m, truth.y_m, truth.yaw_rad};
  const auto lists = [](const Match& match, const Pose2& pose) {
    return std::any_of(match.modes.begin(), match.modes.end(),
                       [&](const MatchMode& mode) { return distance_m(mode.pose, pose) < 0.1; });
  };
  const Cloud cloud = scan_in_first_room(truth);
  const PreparedScan scan(cloud);
  const Match match = matcher->match(scan, std::nullopt);
  EXPECT_TRUE(lists(match, truth));
  EXPECT_FALSE(lists(match, rival));
  const Match rivals = matcher->match_rivals(scan);
  ASSERT_TRUE(lists(rivals, truth));
  EXPECT_TRUE(lists(rivals, rival));
  EXPECT_EQ(rivals.modes.front().pose, match.modes.front().pose);
  EXPECT_LT(rivals.unseen, match.unseen);
  for (const MatchMode& mode : rivals.modes)
    EXPECT_GE(mode.overlap_ratio, rivals.unseen * rivals.modes.front().overlap_ratio);
}

}  // namespace
}  // namespace voxlist::matching
