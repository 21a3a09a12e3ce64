#include "services/mapper/travelled_path.h"

#include <gtest/gtest.h>

namespace voxlist::services {
namespace {

TEST(TravelledPath, IsEachPoseInItsOrder) {
  TravelledPath path;
  path.restore({1, to_pose3({0.5, 0.0, 0.0})});
  for (int i = 2; i < 10; ++i) path.add({i, {double(i), 0.0, 0.0}});
  const auto poses = path.poses();
  ASSERT_EQ(poses.size(), 9u);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(poses[std::size_t(i)].utime_us, i + 1);
  EXPECT_EQ(poses[8].pose.translation().x(), 9.0);
}

TEST(TravelledPath, KeepsOfLongAgoOnlyTheKeyframes) {
  TravelledPath path;
  constexpr int kAll = int(TravelledPath::kNewest) + 1000;
  for (int i = 0; i < kAll; ++i) {
    path.add({i, {}});
    if (i % 100 == 0) path.mark_keyframe();
  }
  const auto poses = path.poses();
  EXPECT_EQ(poses.size(), TravelledPath::kNewest + 10);
  EXPECT_EQ(poses[1].utime_us, 100);
  EXPECT_EQ(poses[10].utime_us, 1000);
  EXPECT_EQ(poses.back().utime_us, kAll - 1);
}

}  // namespace
}  // namespace voxlist::services
