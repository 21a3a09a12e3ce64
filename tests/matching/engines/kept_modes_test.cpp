// Which modes a search of the whole map keeps: rooms in a row that look the same.
#include <gtest/gtest.h>

#include <algorithm>

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

OccupancyMap rooms(int count) {
  OccupancyMap map;
  for (int room = 0; room < count; ++room)
    sample_room(0.02, room, [&](const Eigen::Vector3d& p) {
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
  return make_matcher(map, {})->match(scan, std::nullopt).modes;
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

TEST(KeptModes, AreNoMoreThanFortyEight) {
  EXPECT_EQ(modes(rooms(26), scan_of_the_first()).size(), 48U);
}

}  // namespace
}  // namespace voxlist::matching
