#include "voxlist/voxels/voids/marked_scan.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "voxlist/voxels/occupancy_map.h"
#include "voxlist/voxels/scan_rays.h"
#include "voxlist/voxels/voids/void_scan.h"

namespace voxlist {
namespace {

constexpr std::uint32_t kSeed = 20'261'128;
constexpr double kMin_m = 0.05, kMax_m = 20.0;

Cloud random_cloud(int points) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  Cloud cloud;
  for (int i = 0; i < points; ++i) {
    cloud.points.emplace_back(6.0F * unit(random), 6.0F * unit(random), 1.5F * unit(random));
    cloud.origins.emplace_back(0.1F * unit(random), 0.0F, 0.2F);
  }
  return cloud;
}

using Cells = std::set<Voxel>;

Cells cells_of(const MarkedScan& scan, BlockBits MarkedScan::Block::*bits) {
  Cells cells;
  for (const MarkedScan::Block& block : scan.blocks())
    for (std::size_t bit = 0; bit < 512; ++bit) {
      const Voxel in = cell_of_bit(bit);
      if (((block.*bits)[bit / 64] >> bit % 64 & 1) != 0)
        cells.insert({8 * block.at.x + in.x, 8 * block.at.y + in.y, 8 * block.at.z + in.z});
    }
  return cells;
}

// The slow way.
Cells passed_by(const Cloud& cloud, const Pose3& pose, double gap_m) {
  Cells cells;
  visit_rays(cloud, pose, kMax_m, kFinestResolution_m,
             [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
               const double way_m = (to - from).norm();
               const Eigen::Vector3d end = from + std::max(1.0 - gap_m / way_m, 0.0) * (to - from);
               const Voxel last = voxel_at(to, kPassedResolution_m);
               visit_ray(from, end, kPassedResolution_m, [&](const Voxel& cell) {
                 if (gap_m > 0.0 || cell != last) cells.insert(cell);
                 return true;
               });
             });
  return cells;
}

std::size_t difference(const Cells& a, const Cells& b) {
  std::size_t count = 0;
  for (const Voxel& v : a) count += !b.contains(v);
  for (const Voxel& v : b) count += !a.contains(v);
  return count;
}

// Near the map's origin, and farther from it than a scratch reaches.
TEST(MarkedScan, HasTheCellsOfASlowWalk) {
  for (const double x_m : {1.0, -5000.3}) {
    const Pose3 pose = to_pose3({x_m, 0.4, 0.3});
    const Cloud cloud = random_cloud(3000);
    MarkedScan scan(kMin_m, kMax_m);
    scan.mark(pose, cloud);
    const Cells passed = passed_by(cloud, pose, 0.0), early = passed_by(cloud, pose, kVoidGap_m);
    EXPECT_GT(passed.size(), early.size() + 1000);
    EXPECT_LE(difference(cells_of(scan, &MarkedScan::Block::passed), passed), passed.size() / 1000);
    EXPECT_LE(difference(cells_of(scan, &MarkedScan::Block::early), early), early.size() / 1000);
    Cells hit;
    for (const auto& p : cloud.points)
      hit.insert(voxel_at(Eigen::Vector3d(pose * p.cast<double>()), kPassedResolution_m));
    EXPECT_LE(difference(cells_of(scan, &MarkedScan::Block::hit), hit), 5u);
  }
}

TEST(MarkedScan, FollowsTheRaysOfAScanOnce) {
  const Cloud cloud = random_cloud(300);
  MarkedScan scan(kMin_m, kMax_m);
  scan.mark(Pose3::Identity(), cloud);
  const std::uint64_t first = scan.number();
  scan.mark(Pose3::Identity(), Cloud(cloud));
  EXPECT_EQ(scan.number(), first);
  Cloud other = cloud;
  other.points[7].x() += 0.001F;
  scan.mark(Pose3::Identity(), other);
  EXPECT_NE(scan.number(), first);
  scan.mark(to_pose3({0.001, 0.0, 0.0}), other);
  EXPECT_EQ(scan.number(), first + 2);
}

TEST(MarkedScan, LeavesOutWhatIsNoPoint) {
  MarkedScan scan(kMin_m, 2.0);
  Cloud cloud;
  cloud.points = {{0.0F, 0.0F, 0.0F}, {0.01F, 0.0F, 0.0F}, {3.0F, 0.0F, 0.0F}};
  scan.mark(Pose3::Identity(), cloud);
  EXPECT_TRUE(cells_of(scan, &MarkedScan::Block::passed).empty());
  EXPECT_TRUE(cells_of(scan, &MarkedScan::Block::hit).empty());
}

TEST(HalvedCells, AreThoseWithACellInThem) {
  std::mt19937_64 random(kSeed);
  for (int run = 0; run < 200; ++run) {
    BlockBits cells{};
    for (int i = 0; i < run % 20; ++i) {
      const std::uint64_t bit = random() % 512;
      cells[bit / 64] |= std::uint64_t{1} << bit % 64;
    }
    std::uint64_t expected = 0;
    for (std::size_t bit = 0; bit < 512; ++bit) {
      const Voxel in = cell_of_bit(bit);
      if ((cells[bit / 64] >> bit % 64 & 1) != 0)
        expected |= std::uint64_t{1} << bit_in_block({in.x / 2, in.y / 2, in.z / 2});
    }
    EXPECT_EQ(halved(cells), expected);
  }
}

}  // namespace
}  // namespace voxlist
