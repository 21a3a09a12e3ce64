#include "voxlist/planning/octomap.h"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <sstream>

#include "voxlist/simulation/run/simulated_run.h"

namespace voxlist::planning {
namespace {

using Eigen::Vector3d;

OctomapConfig config(double max_range_m = 100.0) {
  OctomapConfig config;
  config.max_range_m = max_range_m;
  return config;
}

Cloud one_ray(const Eigen::Vector3f& origin, const Eigen::Vector3f& hit) {
  return {0, {hit}, {origin}};
}

// Three sweeps of a simulated robot.
OctomapBuilder simulated_map() {
  simulation::SimulationConfig simulation;
  simulation.duration_s = 3.0;
  simulation::SimulatedRun run(simulation);
  OctomapBuilder builder(config());
  while (const auto event = run.next())
    if (const auto* cloud = std::get_if<Cloud>(&*event))
      builder.insert(to_pose3(run.truth().at(static_cast<double>(cloud->utime_us) * 1e-6)), *cloud);
  return builder;
}

std::string text(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class OctomapFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "voxlist_octomap_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  int run(const std::string& command) const {
    return std::system((command + " >" + (folder_ / "printed").string() + " 2>&1").c_str());
  }

  std::filesystem::path folder_;
};

TEST(Octomap, IsFreeAlongARayOccupiedAtItsHitAndUnknownBeyond) {
  OctomapBuilder builder(config());
  builder.insert(Pose3::Identity(), one_ray({0.05F, 0.05F, 0.65F}, {2.05F, 0.05F, 0.65F}));
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(builder.at({0.05 + 0.1 * i, 0.05, 0.65}), Occupancy::kFree) << i;
  EXPECT_EQ(builder.at({2.05, 0.05, 0.65}), Occupancy::kOccupied);
  EXPECT_EQ(builder.at({2.15, 0.05, 0.65}), Occupancy::kUnknown);
  EXPECT_EQ(builder.at({1.05, 0.15, 0.65}), Occupancy::kUnknown);
  EXPECT_EQ(builder.size().free, 20u);
  EXPECT_EQ(builder.size().occupied, 1u);
  EXPECT_EQ(builder.size().known(), 21u);
}

TEST(Octomap, StartsEachRayWhereItStarted) {
  OctomapBuilder builder(config());
  Cloud cloud = one_ray({0.05F, 0.05F, 0.65F}, {2.05F, 0.05F, 0.65F});
  cloud.points.emplace_back(2.05F, 1.05F, 0.65F);
  cloud.origins.emplace_back(0.05F, 1.05F, 0.65F);
  builder.insert(Pose3::Identity(), cloud);
  EXPECT_EQ(builder.at({1.05, 0.05, 0.65}), Occupancy::kFree);
  EXPECT_EQ(builder.at({1.05, 1.05, 0.65}), Occupancy::kFree);
  EXPECT_EQ(builder.at({1.05, 0.55, 0.65}), Occupancy::kUnknown);
}

TEST(Octomap, PutsACloudWhereItsPoseSays) {
  OctomapBuilder builder(config());
  builder.insert(to_pose3({1.05, 2.05, std::numbers::pi / 2}),
                 one_ray({0.0F, 0.0F, 0.65F}, {1.0F, 0.0F, 0.65F}));
  EXPECT_EQ(builder.at({1.05, 3.05, 0.65}), Occupancy::kOccupied);
  EXPECT_EQ(builder.at({1.05, 2.55, 0.65}), Occupancy::kFree);
}

TEST(Octomap, LeavesOutRaysThatAreTooLongOrTooShort) {
  OctomapBuilder builder(config(1.0));
  builder.insert(Pose3::Identity(), one_ray({0.05F, 0.05F, 0.05F}, {2.05F, 0.05F, 0.05F}));
  builder.insert(Pose3::Identity(), one_ray({0.05F, 0.05F, 0.05F}, {0.05F, 0.09F, 0.05F}));
  builder.insert(Pose3::Identity(), one_ray({0.5F, 0.05F, 0.05F}, {0.0F, 0.0F, 0.0F}));
  EXPECT_EQ(builder.size().known(), 0u);
  builder.insert(Pose3::Identity(), one_ray({0.05F, 0.05F, 0.05F}, {1.0F, 0.05F, 0.05F}));
  EXPECT_EQ(builder.size().occupied, 1u);
}

TEST(Octomap, BoundsWhatOneCloudCostsWhateverItsUnit) {
  OctomapBuilder builder(config());
  Cloud millimetres;
  for (int i = 0; i < 3000; ++i) {
    const float angle = 0.002F * static_cast<float>(i);
    millimetres.points.emplace_back(1000.0F * std::cos(angle), 1000.0F * std::sin(angle), 500.0F);
  }
  builder.insert(Pose3::Identity(), millimetres);
  EXPECT_EQ(builder.size().known(), 0u);
}

TEST(Octomap, LeavesACloudOutWhenItIsToldToStop) {
  OctomapBuilder builder(config());
  Cloud cloud;
  cloud.points.assign(1000, {2.05F, 0.05F, 0.65F});
  int asked = 0;
  EXPECT_FALSE(builder.insert(Pose3::Identity(), cloud, [&] { return ++asked == 3; }));
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(builder.size().known(), 0u);
  EXPECT_TRUE(builder.insert(Pose3::Identity(), cloud, [] { return false; }));
  EXPECT_EQ(builder.size().occupied, 1u);
}

// Rays from the origin to points spread evenly over a sphere.
Cloud sphere(int points, double radius_m) {
  Cloud cloud;
  for (int i = 0; i < points; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / points, r = std::sqrt(1.0 - z * z);
    const double angle = 2.39996 * i;
    const Vector3d direction(r * std::cos(angle), r * std::sin(angle), z);
    cloud.points.push_back((radius_m * direction).cast<float>());
  }
  return cloud;
}

// All 4.4 million voxels on the rays of these 3000 points took 700 MB.
TEST(Octomap, KeepsEveryEndPointAndShortensRaysThatPassTooMuch) {
  OctomapBuilder builder(config());
  builder.insert(Pose3::Identity(), sphere(1000, 9.0));
  EXPECT_TRUE(std::isinf(builder.reach_m()));
  OctomapBuilder far(config());
  const Cloud cloud = sphere(3000, 99.0);
  EXPECT_TRUE(far.insert(Pose3::Identity(), cloud));
  EXPECT_LT(far.size().free, 1'001'000u);
  EXPECT_GT(far.size().free, 990'000u);
  EXPECT_GT(far.reach_m(), 10.0);
  EXPECT_LT(far.reach_m(), 40.0);
  for (const Eigen::Vector3f& p : cloud.points) {
    EXPECT_EQ(far.at(p.cast<double>()), Occupancy::kOccupied);
    EXPECT_EQ(far.at(0.08 * p.cast<double>()), Occupancy::kFree);
    EXPECT_EQ(far.at(0.9 * p.cast<double>()), Occupancy::kUnknown);
  }
}

TEST(Octomap, StopsWhileItPutsVoxelsIn) {
  OctomapBuilder builder(config());
  const Cloud cloud = sphere(1000, 20.0);
  int asked = 0, asked_in_all = 0;
  builder.insert(Pose3::Identity(), cloud, [&] { return ++asked_in_all < 0; });
  EXPECT_GT(asked_in_all, 20);
  OctomapBuilder stopped(config());
  EXPECT_FALSE(stopped.insert(Pose3::Identity(), cloud, [&] { return ++asked == asked_in_all; }));
  EXPECT_GT(stopped.size().known(), 0u);
  EXPECT_LT(stopped.size().known(), builder.size().known());
}

TEST(Octomap, ForgetsSomebodyWhoWalkedBy) {
  OctomapBuilder builder(config());
  const Cloud person = one_ray({0.05F, 0.05F, 0.05F}, {1.05F, 0.05F, 0.05F});
  const Cloud wall = one_ray({0.05F, 0.05F, 0.05F}, {2.05F, 0.05F, 0.05F});
  builder.insert(Pose3::Identity(), person);
  EXPECT_EQ(builder.at({1.05, 0.05, 0.05}), Occupancy::kOccupied);
  for (int i = 0; i < 4; ++i) builder.insert(Pose3::Identity(), wall);
  EXPECT_EQ(builder.at({1.05, 0.05, 0.05}), Occupancy::kFree);
}

TEST(Octomap, LeavesOutRaysThatLeaveTheTree) {
  OctomapBuilder builder(config());
  const Cloud cloud = one_ray({0.0F, 0.0F, 0.0F}, {50.0F, 0.0F, 0.0F});
  builder.insert(to_pose3({3270.0, 0.0, 0.0}), cloud);
  EXPECT_EQ(builder.size().known(), 0u);
}

TEST(Octomap, EqualsOctomapsOwnInsertionWhenAllRaysStartInOnePlace) {
  simulation::SimulationConfig simulation;
  const simulation::SimulatedRun run(simulation);
  Cloud cloud = simulation::scan_sweep(run.scanner(), run.truth(), 10.0, simulation.sweep, 1);
  cloud.origins.assign(cloud.points.size(), {0.0F, 0.0F, 0.6F});

  octomap::OcTree expected(0.1);
  octomap::Pointcloud points;
  for (const Eigen::Vector3f& p : cloud.points) points.push_back(p.x(), p.y(), p.z());
  expected.insertPointCloud(points, {0.0F, 0.0F, 0.6F});
  std::ostringstream expected_bt;
  expected.writeBinary(expected_bt);

  OctomapBuilder builder(config());
  builder.insert(Pose3::Identity(), cloud);
  EXPECT_GT(builder.size().free, 10000u);
  EXPECT_EQ(text(builder.binary()), expected_bt.str());
}

TEST(Octomap, GivesTheSameBytesAgainAndGoesOnAfterGivingThem) {
  const OctomapBuilder first = simulated_map();
  EXPECT_EQ(first.binary(), first.binary());
  EXPECT_EQ(first.binary(), simulated_map().binary());

  OctomapBuilder asked(config()), silent(config());
  const Cloud person = one_ray({0.05F, 0.05F, 0.05F}, {1.05F, 0.05F, 0.05F});
  const Cloud wall = one_ray({0.05F, 0.05F, 0.05F}, {2.05F, 0.05F, 0.05F});
  for (const Cloud& cloud : {person, wall, wall, wall}) {
    asked.insert(Pose3::Identity(), cloud);
    asked.binary();
    silent.insert(Pose3::Identity(), cloud);
  }
  EXPECT_EQ(asked.binary(), silent.binary());
}

// The same whether the bytes were asked for after each cloud, which costs what it changed, or once;
// clouds that confirm, contradict and add.
TEST(Octomap, GivesTheSameBytesHoweverOftenItIsAsked) {
  OctomapBuilder asked(config()), silent(config());
  for (int i = 0; i < 12; ++i) {
    const Cloud cloud = sphere(500, 2.0 + i % 5);
    const Pose3 pose = to_pose3({0.7 * (i % 7), 0.0, 0.1 * i});
    asked.insert(pose, cloud);
    silent.insert(pose, cloud);
    const std::vector<std::uint8_t> bytes = asked.binary();
    std::istringstream in(text(bytes));
    octomap::OcTree tree(0.5);
    ASSERT_TRUE(tree.readBinary(in));
    std::ostringstream expected;
    tree.writeBinary(expected);
    EXPECT_EQ(text(bytes), expected.str()) << i;
  }
  EXPECT_EQ(asked.binary(), silent.binary());
}

TEST(Octomap, IsReadBackByOctomap) {
  const OctomapBuilder builder = simulated_map();
  std::istringstream in(text(builder.binary()));
  octomap::OcTree tree(0.5);
  ASSERT_TRUE(tree.readBinary(in));
  EXPECT_EQ(tree.getResolution(), 0.1);
  std::size_t occupied = 0;
  tree.expand();
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const Occupancy expected = tree.isNodeOccupied(*leaf) ? Occupancy::kOccupied : Occupancy::kFree;
    ASSERT_EQ(builder.at({leaf.getX(), leaf.getY(), leaf.getZ()}), expected);
    if (expected == Occupancy::kOccupied) ++occupied;
  }
  EXPECT_EQ(tree.getNumLeafNodes(), builder.size().known());
  EXPECT_EQ(occupied, builder.size().occupied);
  EXPECT_GT(occupied, 1000u);
}

TEST_F(OctomapFiles, HoldWhatTheBuilderHolds) {
  const OctomapBuilder builder = simulated_map();
  builder.write_bt(folder_ / "map.bt");
  builder.write_ot(folder_ / "map.ot");
  EXPECT_EQ(read_file(folder_ / "map.bt"), text(builder.binary()));
  const std::unique_ptr<octomap::AbstractOcTree> tree(
      octomap::AbstractOcTree::read((folder_ / "map.ot").string()));
  ASSERT_NE(tree, nullptr);
  EXPECT_EQ(tree->getTreeType(), "OcTree");
  EXPECT_EQ(tree->size(), builder.size().nodes);
}

TEST_F(OctomapFiles, AreReadByTheToolsOfOctomap) {
  if (run("command -v convert_octree bt2vrml compare_octrees") != 0)
    GTEST_SKIP() << "the package octomap-tools is not installed";
  const OctomapBuilder builder = simulated_map();
  builder.write_bt(folder_ / "map.bt");
  builder.write_ot(folder_ / "map.ot");
  const std::string bt = (folder_ / "map.bt").string(), ot = (folder_ / "map.ot").string();

  EXPECT_EQ(run("convert_octree " + ot + " " + (folder_ / "again.bt").string()), 0);
  EXPECT_EQ(read_file(folder_ / "again.bt"), read_file(folder_ / "map.bt"));
  EXPECT_EQ(run("bt2vrml " + bt), 0);
  EXPECT_GT(std::filesystem::file_size(bt + ".wrl"), 1000u);
}

}  // namespace
}  // namespace voxlist::planning
