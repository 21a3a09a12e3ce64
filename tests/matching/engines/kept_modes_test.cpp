// Which modes a search of the whole map keeps: rooms in a row that look the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/matching/synthetic_room.h"
#include "voxlist/matching/engines/matcher.h"

namespace voxlist::matching {
namespace {

// An empty room looks the same turned by half a turn: each has two places that fit.
constexpr double kLength_m = 3.0, kDepth_m = 2.0, kApart_m = 4.0;
const Pose2 kTruth{1.1, 0.8, 0.4};

template <class Visit>
void sample_room(double spacing_m, int room, Visit&& visit) {
  RoomSurfaces(kLength_m, kDepth_m, 0, 1).sample(spacing_m, [&](const Eigen::Vector3d& p) {
    visit(Eigen::Vector3d(p.x() + kApart_m * room, p.y(), p.z()));
  });
}

// Whether a point of a room, the first in the row, lies in a gap of that width: one in each long
// wall, which half a turn takes to the other.
bool in_gap(const Eigen::Vector3d& p, double gap_m) {
  constexpr double kMiddle_m = 0.7;
  const double from_middle_m =
      p.y() < kDepth_m / 2 ? p.x() - kMiddle_m : kLength_m - p.x() - kMiddle_m;
  const bool on_long_wall = p.y() < 1e-6 || p.y() > kDepth_m - 1e-6;
  return on_long_wall && p.z() > 1e-6 && std::abs(from_middle_m) < gap_m / 2;
}

// The walls of all rooms but the first have gaps, which the map knows to be free.
OccupancyMap rooms(int count, double gap_m = 0.0) {
  OccupancyMap map;
  for (int room = 0; room < count; ++room)
    sample_room(0.02, room, [&](const Eigen::Vector3d& p) {
      const Eigen::Vector3d in_room(p.x() - kApart_m * room, p.y(), p.z());
      if (room > 0 && in_gap(in_room, gap_m))
        map.passed.insert(voxel_at(p, kPassedResolution_m));
      else
        map.occupied.insert(voxel_at(p, kFinestResolution_m));
    });
  return map;
}

Cloud scan_of_the_first() {
  Cloud scan;
  sample_room(0.1, 0, [&](const Eigen::Vector3d& p) {
    scan.points.push_back((kTruth.inverse() * p).cast<float>());
  });
  return scan;
}

std::vector<MatchMode> modes(const OccupancyMap& map, const Cloud& scan) {
  return make_matcher(map, {})->match(PreparedScan(scan), std::nullopt).modes;
}

bool lists(const std::vector<MatchMode>& modes, const Pose2& pose) {
  return std::any_of(modes.begin(), modes.end(),
                     [&](const MatchMode& mode) { return distance_m(mode.pose, pose) < 0.1; });
}

TEST(KeptModes, AreAllThatTheMapSupportsAlike) {
  const auto kept = modes(rooms(7), scan_of_the_first());
  EXPECT_EQ(kept.size(), 14U);
  for (int room = 0; room < 7; ++room)
    EXPECT_TRUE(lists(kept, {kTruth.x_m + kApart_m * room, kTruth.y_m, kTruth.yaw_rad})) << room;
}

// Of 14 places; the support of 12 is more than 0.08 below that of the other two.
TEST(KeptModes, AreTheBestEightWhereTheMapSupportsTheOthersFarLess) {
  const auto kept = modes(rooms(7, 0.48), scan_of_the_first());
  ASSERT_EQ(kept.size(), 8U);
  EXPECT_TRUE(lists({kept[0], kept[1]}, kTruth));
  EXPECT_LT(kept[2].support, kept[1].support - 0.08);
}

TEST(KeptModes, AreAllThatTheMapSupportsALittleLess) {
  const auto kept = modes(rooms(7, 0.3), scan_of_the_first());
  ASSERT_EQ(kept.size(), 14U);
  EXPECT_LT(kept.back().support, kept.front().support - 0.02);
  EXPECT_GT(kept.back().support, kept.front().support - 0.08);
}

TEST(KeptModes, AreNoMoreThanFortyEight) {
  EXPECT_EQ(modes(rooms(26), scan_of_the_first()).size(), 48U);
}

}  // namespace
}  // namespace voxlist::matching
