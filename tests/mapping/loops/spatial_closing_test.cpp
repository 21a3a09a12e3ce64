// A drive round a block whose map rises and leans a little more at each step.
#include "voxlist/mapping/loops/spatial_closing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/mapping/graph/block_drive.h"
#include "tests/mapping/loops/bent_block.h"

namespace voxlist::mapping {
namespace {

// Keyframes as a drive has them that climbs 4 mm and a fortieth of a degree too much at each step,
// and turns too far: neighbours stand to each other nearly as they should.
MapKeyframes risen(const std::vector<Pose2>& truth) {
  MapKeyframes keyframes;
  Pose3 pose = to_pose3(truth.front());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i > 0)
      pose = pose * to_pose3(truth[i - 1].inverse() * truth[i] * Pose2{0.0, 0.0, 0.001},
                             {0.004, 0.0, -0.0004});
    keyframes.push_back({.utime_us = static_cast<std::int64_t>(i),
                         .T_map_keyframe = to_pose2(pose),
                         .tilt = tilt_of(pose)});
  }
  return keyframes;
}

// Root mean squares of height (m), roll and pitch (rad), of which the truth is 0.
Eigen::Array3d rmse(const MapKeyframes& keyframes) {
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  for (const auto& keyframe : keyframes)
    squares += Eigen::Array3d(keyframe.tilt->z_m, keyframe.tilt->roll_rad, keyframe.tilt->pitch_rad)
                   .square();
  return (squares / static_cast<double>(keyframes.size())).sqrt();
}

std::vector<Pose2> planar_of(const MapKeyframes& keyframes) {
  std::vector<Pose2> poses;
  for (const auto& keyframe : keyframes) poses.push_back(keyframe.T_map_keyframe);
  return poses;
}

class SpatialClosing : public testing::Test {
 protected:
  SessionClosing close(const MapKeyframes& keyframes, LookMemory* memory = nullptr) {
    const ReadCloud level = [&](std::size_t i) {
      ++reads_;
      const Pose3 T_map_base = to_pose3(keyframes[i].T_map_keyframe, *keyframes[i].tilt);
      return level_cloud({T_map_base, scan_block(truth_[i], i + 1)});
    };
    return close_sessions(keyframes, level, {}, {}, memory);
  }

  const std::vector<Pose2> truth_ = way_round(12.0);
  int reads_ = 0;
};

TEST_F(SpatialClosing, HeightAndTiltOfADriveThatComesBackAreClosed) {
  const MapKeyframes before = risen(truth_);
  LookMemory memory;
  const SessionClosing closing = close(before, &memory);
  ASSERT_TRUE(closing.moves);
  const MapKeyframes after = moved(before, closing);
  const Eigen::Array3d was = rmse(before), is = rmse(after);
  EXPECT_GT(was[0], 0.1);
  EXPECT_LT(is[0], 0.08) << was.transpose() << ", then " << is.transpose();
  EXPECT_LT(is[1], 0.003);
  EXPECT_LT(is[2], 0.003);
  EXPECT_LT(rmse_m(planar_of(after), truth_), 0.03);
  for (const PoseEdge& edge : closing.edges) EXPECT_TRUE(edge.in_space);
  reads_ = 0;
  const MapKeyframes again = moved(before, close(before, &memory));
  EXPECT_EQ(reads_, 0);
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_EQ(again[i].tilt, after[i].tilt);
}

TEST_F(SpatialClosing, AMapThatIsClosedStaysAsItIs) {
  MapKeyframes keyframes = risen(truth_);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    keyframes[i].T_map_keyframe = truth_[i];
    keyframes[i].tilt = Tilt{0.0, 0.0, i == 3 ? 1e-9 : 0.0};
  }
  EXPECT_FALSE(close(keyframes).moves);
  EXPECT_GT(reads_, 0);
}

}  // namespace
}  // namespace voxlist::mapping
