#include "voxlist/planning/octomap.h"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <sstream>
#include <vector>

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

// Boxes of each kind about where the simulated robot drove.
std::vector<PlacedBox> edits() {
  const Eigen::AlignedBox3d middle(Vector3d(-1.0, -1.0, -0.5), Vector3d(1.0, 1.0, 2.0));
  PlacedBox turned{EditKind::kKeepFree, middle, {2.0, 1.0, 0.5}};
  return {{EditKind::kErase, middle, {-2.0, 0.0, 0.0}},
          turned,
          {EditKind::kKeepBlocked, middle, {30.0, 0.0, 0.0}}};
}

TEST(Octomap, HasEditsLastWhateverIsInsertedAfterwards) {
  const Cloud cloud = one_ray({0.f, 0.f, 0.5f}, {3.f, 0.f, 0.5f});
  OctomapBuilder early = simulated_map(), late = simulated_map();
  const std::string plain = text(early.binary());
  early.edit(edits());
  EXPECT_NE(text(early.binary()), plain);
  for (OctomapBuilder* builder : {&early, &late}) builder->insert(Pose3::Identity(), cloud);
  late.edit(edits());
  EXPECT_EQ(text(early.binary()), text(late.binary()));
  const OctomapCut coarse{.resolution_m = 0.4, .box = {}};
  EXPECT_EQ(text(early.binary(coarse)), text(late.binary(coarse)));
  EXPECT_EQ(early.size().free, late.size().free);
  EXPECT_EQ(early.at({30.0, 0.0, 0.5}), Occupancy::kOccupied);
  EXPECT_EQ(early.at({2.0, 1.0, 0.5}), Occupancy::kFree);
  EXPECT_NE(early.at({-2.0, 0.0, 0.0}), Occupancy::kOccupied);
}

TEST(Octomap, IsAsItWasOnceItsEditsAreTakenBack) {
  OctomapBuilder builder = simulated_map();
  const std::string plain = text(builder.binary());
  builder.edit(edits());
  builder.binary();
  builder.edit({});
  EXPECT_EQ(text(builder.binary()), plain);
  EXPECT_EQ(builder.at({30.0, 0.0, 0.5}), Occupancy::kUnknown);
}

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

// All rays of these 30,000 points pass 20 million voxels in 900,000 blocks.
TEST(Octomap, KeepsEveryEndPointAndShortensRaysThatPassTooMuch) {
  OctomapBuilder builder(config());
  builder.insert(Pose3::Identity(), sphere(3000, 50.0));
  EXPECT_TRUE(std::isinf(builder.reach_m()));
  OctomapBuilder far(config());
  const Cloud cloud = sphere(30'000, 99.0);
  EXPECT_TRUE(far.insert(Pose3::Identity(), cloud));
  EXPECT_GT(far.reach_m(), 20.0);
  EXPECT_LT(far.reach_m(), 80.0);
  const double free_m = 0.95 * far.reach_m(), unknown_m = 1.05 * far.reach_m();
  std::size_t unknown = 0;
  for (const Eigen::Vector3f& p : cloud.points) {
    const Vector3d way = p.cast<double>().normalized();
    ASSERT_EQ(far.at(p.cast<double>()), Occupancy::kOccupied);
    ASSERT_EQ(far.at(free_m * way), Occupancy::kFree);
    unknown += far.at(unknown_m * way) == Occupancy::kUnknown;
  }
  EXPECT_GT(unknown, cloud.points.size() / 2);
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

// Against OctoMap's own insertPointCloud, whose rays are rounded otherwise: to floats.
TEST(Octomap, HoldsWhatOctomapHoldsAfterManyClouds) {
  octomap::OcTree tree(0.1);
  OctomapBuilder builder(config());
  for (int i = 0; i < 12; ++i) {
    const Cloud cloud = sphere(2000, 2.0 + i % 5);
    const Pose3 pose = to_pose3({0.7 * (i % 7), 0.33, 0.1 * i});
    builder.insert(pose, cloud);
    octomap::Pointcloud points;
    for (const Eigen::Vector3f& p : cloud.points) {
      const Eigen::Vector3f q = (pose * p.cast<double>()).cast<float>();
      points.push_back(q.x(), q.y(), q.z());
    }
    const Eigen::Vector3f origin = pose.translation().cast<float>();
    tree.insertPointCloud(points, {origin.x(), origin.y(), origin.z()});
  }
  tree.expand();
  std::size_t alike = 0, known = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf, ++known) {
    const bool occupied = tree.isNodeOccupied(*leaf);
    alike += builder.at({leaf.getX(), leaf.getY(), leaf.getZ()}) ==
             (occupied ? Occupancy::kOccupied : Occupancy::kFree);
  }
  EXPECT_GT(known, 100'000u);
  EXPECT_GE(static_cast<double>(alike), 0.9999 * static_cast<double>(known));
  EXPECT_LE(builder.size().known(), known + known / 10'000);
}

TEST(Octomap, IsTheSameForAnyNumberOfThreads) {
  const auto bytes_of = [](int threads) {
    OctomapBuilder builder(config());
    int i = 0;
    EXPECT_TRUE(builder.insert_all(
        [&]() -> std::optional<PosedCloud> {
          if (i == 40) return std::nullopt;
          ++i;
          return PosedCloud{to_pose3({0.3 * (i % 7), 0.33, 0.1 * i}), sphere(500, 2.0 + i % 5)};
        },
        threads));
    return builder.binary();
  };
  OctomapBuilder one_by_one(config());
  for (int i = 1; i <= 40; ++i)
    one_by_one.insert(to_pose3({0.3 * (i % 7), 0.33, 0.1 * i}), sphere(500, 2.0 + i % 5));
  for (const int threads : {1, 2, 4})
    EXPECT_TRUE(bytes_of(threads) == one_by_one.binary()) << threads;
}

// Clouds along a way, some in sight of one another.
std::vector<PosedCloud> clouds_along_a_way() {
  std::vector<PosedCloud> clouds;
  for (int i = 0; i < 20; ++i)
    clouds.push_back({to_pose3({1.3 * i, 0.33, 0.1 * i}), sphere(400, 2.0 + i % 4)});
  return clouds;
}

std::function<std::optional<PosedCloud>()> one_by_one(const std::vector<PosedCloud>& clouds) {
  return [&clouds, i = std::size_t{0}]() mutable -> std::optional<PosedCloud> {
    if (i == clouds.size()) return std::nullopt;
    return clouds[i++];
  };
}

OctomapBuilder map_of(const std::vector<PosedCloud>& clouds) {
  OctomapBuilder builder(config());
  EXPECT_TRUE(builder.insert_all(one_by_one(clouds), 1));
  return builder;
}

TEST(Octomap, IsAsIfACloudHadNeverBeenInOnceItIsTakenOut) {
  std::vector<PosedCloud> clouds = clouds_along_a_way();
  OctomapBuilder builder = map_of(clouds);
  const PosedCloud gone = clouds[7];
  clouds.erase(clouds.begin() + 7);
  EXPECT_FALSE(builder.binary() == map_of(clouds).binary());
  EXPECT_TRUE(builder.recount({{gone, std::nullopt}}, one_by_one(clouds), 1));
  EXPECT_TRUE(builder.binary() == map_of(clouds).binary());
}

TEST(Octomap, IsAsIfCloudsHadAlwaysBeenWhereTheyAreMovedTo) {
  std::vector<PosedCloud> clouds = clouds_along_a_way();
  OctomapBuilder builder = map_of(clouds);
  builder.binary();
  std::vector<CloudMove> moves;
  for (const std::size_t i : {3u, 4u, 12u}) {
    moves.push_back({clouds[i], to_pose3({1.3 * static_cast<double>(i), 4.0, 1.0})});
    clouds[i].T_map_base = *moves.back().T_map_base;
  }
  EXPECT_TRUE(builder.recount(moves, one_by_one(clouds), 2));
  EXPECT_TRUE(builder.binary() == map_of(clouds).binary());
}

TEST(Octomap, StopsBetweenManyClouds) {
  OctomapBuilder builder(config());
  int handed_out = 0, asked = 0;
  EXPECT_FALSE(builder.insert_all(
      [&]() -> std::optional<PosedCloud> {
        if (++handed_out == 100) return std::nullopt;
        return PosedCloud{Pose3::Identity(), sphere(50, 2.0)};
      },
      1, [&] { return ++asked > 10; }));
  EXPECT_LT(handed_out, 100);
  EXPECT_EQ(builder.size().known(), [] {
    OctomapBuilder few(config());
    for (int i = 0; i < 10; ++i) few.insert(Pose3::Identity(), sphere(50, 2.0));
    return few.size().known();
  }());
}

TEST(Octomap, GivesTheSameBytesAgainAndGoesOnAfterGivingThem) {
  const OctomapBuilder first = simulated_map();
  EXPECT_TRUE(first.binary() == first.binary());
  EXPECT_TRUE(first.binary() == simulated_map().binary());

  OctomapBuilder asked(config()), silent(config());
  const Cloud person = one_ray({0.05F, 0.05F, 0.05F}, {1.05F, 0.05F, 0.05F});
  const Cloud wall = one_ray({0.05F, 0.05F, 0.05F}, {2.05F, 0.05F, 0.05F});
  for (const Cloud& cloud : {person, wall, wall, wall}) {
    asked.insert(Pose3::Identity(), cloud);
    asked.binary();
    silent.insert(Pose3::Identity(), cloud);
  }
  EXPECT_TRUE(asked.binary() == silent.binary());
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
    EXPECT_TRUE(text(bytes) == expected.str()) << i;
  }
  EXPECT_TRUE(asked.binary() == silent.binary());
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
  EXPECT_TRUE(read_file(folder_ / "map.bt") == text(builder.binary()));
  const std::unique_ptr<octomap::AbstractOcTree> read(
      octomap::AbstractOcTree::read((folder_ / "map.ot").string()));
  auto* tree = dynamic_cast<octomap::OcTree*>(read.get());
  ASSERT_NE(tree, nullptr);
  std::ostringstream bt;
  ASSERT_TRUE(tree->writeBinaryConst(bt));
  tree->expand();
  EXPECT_EQ(tree->getNumLeafNodes(), builder.size().known());
  for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf) {
    ASSERT_EQ(builder.at({leaf.getX(), leaf.getY(), leaf.getZ()}),
              tree->isNodeOccupied(*leaf) ? Occupancy::kOccupied : Occupancy::kFree);
    ASSERT_GE(leaf->getLogOdds(), -2.0F);
    ASSERT_LE(leaf->getLogOdds(), 3.5F);
  }
}

// The file is that of a tree that OctoMap itself makes leaf by leaf, and prunes.
TEST_F(OctomapFiles, AreThoseOfATreeOfTheSameLeaves) {
  const OctomapBuilder builder = simulated_map();
  builder.write_ot(folder_ / "map.ot");
  const std::unique_ptr<octomap::AbstractOcTree> read(
      octomap::AbstractOcTree::read((folder_ / "map.ot").string()));
  auto* tree = dynamic_cast<octomap::OcTree*>(read.get());
  ASSERT_NE(tree, nullptr);
  octomap::OcTree leaves(0.1);
  tree->expand();
  for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf)
    leaves.setNodeValue(leaf.getKey(), leaf->getLogOdds(), true);
  leaves.updateInnerOccupancy();
  leaves.prune();
  std::ostringstream ot;
  ASSERT_TRUE(leaves.write(ot));
  EXPECT_TRUE(ot.str() == read_file(folder_ / "map.ot"));
}

TEST_F(OctomapFiles, MayHoldABoxInLargerVoxels) {
  const OctomapBuilder builder = simulated_map();
  const VoxelBox box{{-20, -30, 0}, {25, 13, 9}};
  builder.write_bt(folder_ / "part.bt", {0.3, box});
  octomap::OcTree tree(0.5);
  ASSERT_TRUE(tree.readBinary((folder_ / "part.bt").string()));
  EXPECT_EQ(tree.getResolution(), 0.3);
  std::map<Voxel, Occupancy> expected;
  for (int x = box.lowest.x; x <= box.highest.x; ++x)
    for (int y = box.lowest.y; y <= box.highest.y; ++y)
      for (int z = box.lowest.z; z <= box.highest.z; ++z) {
        const Voxel cell{x, y, z};
        const Occupancy here = builder.at(center(cell, 0.1));
        Occupancy& larger = expected[voxel_at(center(cell, 0.1), 0.3)];
        larger = std::max(larger, here);
      }
  std::size_t known = 0, occupied = 0;
  for (const auto& [cell, state] : expected) {
    const Vector3d at = center(cell, 0.3);
    const octomap::OcTreeNode* node = tree.search(at.x(), at.y(), at.z());
    ASSERT_EQ(node != nullptr, state != Occupancy::kUnknown);
    known += node != nullptr;
    occupied += state == Occupancy::kOccupied;
    if (node != nullptr) {
      ASSERT_EQ(tree.isNodeOccupied(node), state == Occupancy::kOccupied);
    }
  }
  tree.expand();
  EXPECT_EQ(tree.getNumLeafNodes(), known);
  EXPECT_GT(occupied, 20u);
  EXPECT_GT(known, occupied + 100);
}

// A part that is asked for after each cloud costs what the cloud changed; read by OctoMap itself.
TEST(Octomap, GivesTheSamePartHoweverOftenItIsAsked) {
  const std::vector<OctomapCut> cuts{{0.25, std::nullopt},
                                     {0.0, VoxelBox{{-9, -13, -8}, {70, 12, 11}}},
                                     {0.2, VoxelBox{{-9, -13, -8}, {70, 12, 11}}}};
  const std::vector<PosedCloud> clouds = clouds_along_a_way();
  for (const OctomapCut& cut : cuts) {
    OctomapBuilder asked(config());
    for (std::size_t i = 0; i < 9; ++i) {
      asked.insert(clouds[i].T_map_base, clouds[i].cloud);
      const std::string bytes = text(asked.binary(cut));
      OctomapBuilder silent = map_of({clouds.begin(), clouds.begin() + std::ptrdiff_t(i) + 1});
      ASSERT_TRUE(bytes == text(silent.binary(cut))) << i;
      std::istringstream in(bytes);
      octomap::OcTree tree(0.5);
      ASSERT_TRUE(tree.readBinary(in));
      std::ostringstream again;
      tree.writeBinary(again);
      EXPECT_TRUE(bytes == again.str()) << i;
      EXPECT_GT(tree.size(), 1000u);
    }
    EXPECT_FALSE(asked.binary(cut) == asked.binary());
  }
}

TEST(Octomap, FollowsACloudThatIsTakenOutInAPartToo) {
  const OctomapCut cut{0.25, VoxelBox{{-9, -13, -8}, {200, 12, 11}}};
  std::vector<PosedCloud> clouds = clouds_along_a_way();
  OctomapBuilder builder = map_of(clouds);
  const auto before = builder.binary(cut);
  const PosedCloud gone = clouds[7];
  clouds.erase(clouds.begin() + 7);
  EXPECT_TRUE(builder.recount({{gone, std::nullopt}}, one_by_one(clouds), 1));
  EXPECT_FALSE(builder.binary(cut) == before);
  EXPECT_TRUE(builder.binary(cut) == map_of(clouds).binary(cut));
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
