#include "voxlist/matching/localisation/pose_track.h"

#include <gtest/gtest.h>

namespace voxlist::matching {
namespace {

constexpr Evidence kAgrees{.points = 100, .hits = 98, .misses = 2, .rays = 100};

Cloud cloud_at(std::int64_t utime_us) {
  Cloud cloud;
  cloud.utime_us = utime_us;
  return cloud;
}

MatchMode mode_at(const Pose2& pose) {
  MatchMode mode;
  mode.pose = pose;
  mode.overlap = mode.fit = 0.9;
  return mode;
}

// How a pose is judged that agrees with the map but lies `off_m` from where the robot was, while
// odometry, if there is any, says that it stood.
PoseTrack::Verdict verdict(double off_m, bool with_odometry) {
  const auto odometry = with_odometry ? std::optional(Pose2{}) : std::nullopt;
  const PoseTrack track(cloud_at(0), odometry, {}, 0.98);
  return track.judge(cloud_at(1'000'000), odometry, mode_at({off_m, 0.0, 0.0}), kAgrees).verdict;
}

TEST(PoseTrack, DoubtsAMotionThatOdometryDenies) {
  EXPECT_EQ(verdict(0.02, true), PoseTrack::Verdict::kExplains);
  EXPECT_EQ(verdict(0.3, true), PoseTrack::Verdict::kDoubtful);
}

TEST(PoseTrack, BelievesAnyMotionThatNothingMeasured) {
  EXPECT_EQ(verdict(0.3, false), PoseTrack::Verdict::kExplains);
}

TEST(PoseTrack, ValuesADeniedMotionLess) {
  const PoseTrack track(cloud_at(0), Pose2{}, {}, 0.98);
  const auto worth = [&](double off_m) {
    return track.judge(cloud_at(1'000'000), Pose2{}, mode_at({off_m, 0.0, 0.0}), kAgrees).worth;
  };
  EXPECT_LT(worth(0.3), worth(0.02) - 0.05);
  EXPECT_EQ(worth(0.3), worth(3.0)) << "wheels slip: it never counts for more";
}

}  // namespace
}  // namespace voxlist::matching
