#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "tests/matching/synthetic_room.h"
#include "voxlist/matching/surfaces/refine.h"

namespace voxlist::matching {
namespace {

// Points of flat walls with noise across and along, as a scanner gives them.
class NoisyRoom {
 public:
  NoisyRoom(double half_x_m, double half_y_m, bool ends, unsigned seed)
      : half_x_m_(half_x_m), half_y_m_(half_y_m), ends_(ends), random_(seed) {}

  Eigen::Vector3d point() {
    const double x = even_(random_) * half_x_m_, y = even_(random_) * half_y_m_,
                 z = 1.0 + even_(random_);
    const double side = random_() % 2 == 0 ? 1.0 : -1.0;
    const bool end = ends_ && random_() % 2 == 0;
    const Eigen::Vector3d noise(noise_(random_), noise_(random_), noise_(random_));
    return (end ? Eigen::Vector3d(side * half_x_m_, y, z)
                : Eigen::Vector3d(x, side * half_y_m_, z)) +
           noise;
  }

  // Made of scans, each misplaced by itself; not by default.
  OccupancyMap map(int points, int scans = 1, double misplaced_m = 0.0,
                   double misplaced_rad = 0.0) {
    OccupancyMap map;
    std::normal_distribution<double> normal;
    for (int scan = 0; scan < scans; ++scan) {
      const Pose2 off{misplaced_m * normal(random_), misplaced_m * normal(random_),
                      misplaced_rad * normal(random_)};
      for (int i = 0; i < points / scans; ++i) map.occupied.insert(voxel_at(off * point(), 0.02));
    }
    return map;
  }

  std::vector<Eigen::Vector3f> scan(const Pose2& truth, int points) {
    std::vector<Eigen::Vector3f> scan;
    const Pose2 T_base_map = truth.inverse();
    for (int i = 0; i < points; ++i) scan.push_back((T_base_map * point()).cast<float>());
    return scan;
  }

  double even() { return even_(random_); }

 private:
  double half_x_m_, half_y_m_;
  bool ends_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> even_{-1.0, 1.0};
  std::normal_distribution<double> noise_{0.0, 0.015};
};

double normalised(const Refinement& refined, const Pose2& truth) {
  const Eigen::Vector3d off(refined.pose.x_m - truth.x_m, refined.pose.y_m - truth.y_m,
                            wrap_angle(refined.pose.yaw_rad - truth.yaw_rad));
  return off.dot(refined.covariance.ldlt().solve(off));
}

// 30 rooms, 10 scans in each: the errors of one map are shared.
TEST(Covariance, TellsTheErrorsOfThreeHundredScans) {
  double sum = 0.0;
  int below = 0, scans = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    NoisyRoom room(3.03 + 0.003 * seed, 2.26 + 0.002 * seed, true, seed);
    const OccupancyMap map = room.map(40'000);
    const SurfelMap surfels(map);
    for (int i = 0; i < 10; ++i, ++scans) {
      const Pose2 truth{room.even(), room.even(), 3.0 * room.even()};
      const auto refined =
          refine(surfels, room.scan(truth, 1500), truth * Pose2{0.03, -0.02, 0.01});
      const double value = normalised(refined, truth);
      sum += value;
      below += value < 7.815;
    }
  }
  EXPECT_GT(sum / scans, 0.7);
  EXPECT_LT(sum / scans, 4.5);
  EXPECT_GT(below, 0.9 * scans);
}

// What a map's scans are off by together, no scan in it can see.
TEST(Covariance, TellsTheErrorsInMapsOfMisplacedScans) {
  double sum = 0.0;
  constexpr int kRooms = 100;
  for (unsigned seed = 1; seed <= kRooms; ++seed) {
    NoisyRoom room(3.03 + 0.003 * seed, 2.26 + 0.002 * seed, true, seed);
    const OccupancyMap map = room.map(20'000, 10, 0.005, 0.001);
    const Pose2 truth{room.even(), room.even(), 3.0 * room.even()};
    sum += normalised(
        refine(SurfelMap(map), room.scan(truth, 1500), truth * Pose2{0.03, -0.02, 0.01}), truth);
  }
  EXPECT_GT(sum / kRooms, 0.7);
  EXPECT_LT(sum / kRooms, 4.5);
}

// Nothing tells where along a bare corridor the robot is, whatever normals look like by chance.
TEST(Covariance, LeavesACorridorsLongAxisOpen) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    NoisyRoom corridor(8.0, 1.1, false, seed);
    const OccupancyMap map = corridor.map(30'000);
    const SurfelMap surfels(map);
    const RefineConfig config;
    const auto refined = refine(surfels, corridor.scan({}, 2000), Pose2{0.05, 0.03, 0.0}, config);
    EXPECT_GT(std::sqrt(refined.covariance(0, 0)), 0.5 * config.start_sigma_m) << "seed " << seed;
    EXPECT_LT(std::sqrt(refined.covariance(1, 1)), 0.005) << "seed " << seed;
  }
}

// Nor may such normals drag the pose along it.
TEST(Refine, StaysWhereItWasAlongABareCorridor) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    NoisyRoom corridor(8.0, 1.1, false, seed);
    const OccupancyMap map = corridor.map(30'000);
    const Pose2 start{0.05, 0.03, 0.0};
    const auto refined = refine(SurfelMap(map), corridor.scan({}, 2000), start);
    EXPECT_NEAR(refined.pose.x_m, start.x_m, 0.01) << "seed " << seed;
    EXPECT_NEAR(refined.pose.y_m, 0.0, 0.01) << "seed " << seed;
  }
}

TEST(SpatialRefine, RecoversHeightAndTilt) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto room = synthetic_room(6.0, 5.0, {2.5, 2.0, 0.7}, 8000, seed);
    const OccupancyMap map{room.map, VoxelMap(kPassedResolution_m)};
    const SurfelMap surfels(map);
    const Pose3 truth = to_pose3(room.truth);
    Pose3 start = truth;
    start.translation() += Eigen::Vector3d(0.03, -0.03, 0.03);
    start.linear() = start.linear() * Eigen::AngleAxisd(0.035, Eigen::Vector3d(0.6, 0.8, 0.0));
    const SpatialRefinement refined = refine(surfels, room.scan, start);
    EXPECT_TRUE(refined.converged) << "seed " << seed;
    EXPECT_LT((refined.pose.translation() - truth.translation()).norm(), 0.02) << "seed " << seed;
    EXPECT_LT(Eigen::AngleAxisd(refined.pose.linear().transpose() * truth.linear()).angle(), 0.004)
        << "seed " << seed;
    EXPECT_GT(refined.covariance.ldlt().vectorD().minCoeff(), 0.0);
  }
}

// Along a corridor nothing holds x but strips across its ceiling, three voxels wide and as steep as
// a scan line's noise may make them.
TEST(Covariance, WithoutLinesHasNothingOfACorridorsAxis) {
  NoisyRoom corridor(10.0, 1.2, false, 5);
  OccupancyMap map = corridor.map(60000);
  std::vector<Eigen::Vector3f> points = corridor.scan({}, 3000);
  for (int x = -400; x < 400; x += 50)
    for (int y = -50; y < 50; ++y)
      for (int k = 0; k < 3; ++k) {
        map.occupied.insert({x + k, y, 120 + k});
        points.push_back({0.02F * (float(x + k) + 0.5F), 0.02F * (float(y) + 0.5F),
                          0.02F * (120.5F + float(k))});
      }
  const SurfelMap surfels(map);
  const UncertainPose vague{{}, Eigen::Vector3d(1.0, 1.0, 0.01).asDiagonal()};
  const Refinement refined = refine(surfels, points, Pose2{}, vague);
  EXPECT_LT(std::sqrt(refined.covariance(0, 0)), 0.1);
  const Eigen::Matrix3d firm =
      covariance_without_lines(surfels, points, refined.pose, vague.covariance);
  EXPECT_GT(std::sqrt(firm(0, 0)), 0.9);
  EXPECT_LT(std::sqrt(firm(1, 1)), 0.05);
}

}  // namespace
}  // namespace voxlist::matching
