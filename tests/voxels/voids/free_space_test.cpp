#include "voxlist/voxels/voids/free_space.h"

#include <gtest/gtest.h>

namespace voxlist {
namespace {

// A ray along x at half a metre's height, from the origin.
Cloud ray_to(float x_m) { return {0, {{x_m, 0.01F, 0.5F}}, {{0.01F, 0.01F, 0.5F}}}; }

class FreeSpaceOfRays {
 public:
  ChangedBlocks look(float x_m) {
    scan_.mark(Pose3::Identity(), ray_to(x_m));
    for (const MarkedScan::Block& block : scan_.blocks()) space.count(block);
    return space.follow();
  }

  bool is_free(double x_m) const { return space.map().passed.contains(cell(x_m)); }
  bool is_occupied(double x_m) const { return space.map().occupied.contains(cell(x_m)); }

  FreeSpace space;

 private:
  static Voxel cell(double x_m) {
    return voxel_at(Eigen::Vector3d(x_m, 0.01, 0.5), kPassedResolution_m);
  }

  MarkedScan scan_{0.05, 100.0};
};

TEST(FreeSpace, IsFreeUpToWhatWasHitAndUnknownBeyond) {
  FreeSpaceOfRays rays;
  rays.look(2.01F);
  EXPECT_TRUE(rays.is_free(0.5));
  EXPECT_TRUE(rays.is_free(1.95)) << "the cell before the end";
  EXPECT_TRUE(rays.is_occupied(2.01));
  EXPECT_FALSE(rays.is_free(2.01));
  EXPECT_FALSE(rays.is_free(2.1) || rays.is_occupied(2.1));
}

TEST(FreeSpace, FollowsWhatGoesAndWhatComes) {
  FreeSpaceOfRays rays;
  for (int i = 0; i < 3; ++i) rays.look(2.01F);
  for (int i = 0; i < 9; ++i) rays.look(4.01F);
  EXPECT_TRUE(rays.is_free(2.01));
  EXPECT_FALSE(rays.is_occupied(2.01));
  for (int i = 0; i < 3; ++i) rays.look(2.01F);
  EXPECT_TRUE(rays.is_occupied(2.01));
}

TEST(FreeSpace, NamesTheBlocksThatAreOtherOnesNow) {
  FreeSpaceOfRays rays;
  const ChangedBlocks first = rays.look(2.01F);
  EXPECT_EQ(first.occupied, (std::vector<Voxel>{{3, 0, 0}}));
  EXPECT_EQ(first.passed, (std::vector<Voxel>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}));
  const ChangedBlocks again = rays.look(2.01F);
  EXPECT_TRUE(again.occupied.empty() && again.passed.empty()) << "counted, but free as before";
  EXPECT_EQ(again.from, again.to);
  const ChangedBlocks farther = rays.look(2.09F);
  EXPECT_EQ(farther.occupied, (std::vector<Voxel>{{3, 0, 0}}));
  EXPECT_TRUE(farther.passed.empty()) << "hit once or twice and passed once: still occupied";
}

}  // namespace
}  // namespace voxlist
