#include "voxlist/voxels/edits/edited_map.h"

#include <gtest/gtest.h>

#include <random>

namespace voxlist {
namespace {

PlacedBox box(EditKind kind, double from_m, double to_m) {
  return {kind, {Eigen::Vector3d::Constant(from_m), Eigen::Vector3d::Constant(to_m)}};
}

// Hits and passed cells up to 1.28 m from the origin, on all sides.
OccupancyMap full_map() {
  OccupancyMap map;
  VoxelBlock all;
  all.fill(~std::uint64_t{0});
  for (int z = -8; z < 8; ++z)
    for (int y = -8; y < 8; ++y)
      for (int x = -8; x < 8; ++x) map.occupied.set_block({x, y, z}, all);
  for (int z = -2; z < 2; ++z)
    for (int y = -2; y < 2; ++y)
      for (int x = -2; x < 2; ++x) map.passed.set_block({x, y, z}, all);
  return map;
}

ChangedBlocks nothing(const OccupancyMap& map) { return {{}, {}, map.revision(), map.revision()}; }

std::size_t cells_in(const VoxelMap& map, double from_m, double to_m) {
  std::size_t count = 0;
  map.for_each_voxel([&](const Voxel& v) {
    const Eigen::Vector3d at = center(v, map.resolution_m());
    count += at.minCoeff() > from_m && at.maxCoeff() < to_m;
  });
  return count;
}

TEST(EditedMap, KnowsNothingForMatchingWhereABoxIsErasedOrKeptFree) {
  for (const EditKind kind : {EditKind::kErase, EditKind::kKeepFree}) {
    const OccupancyMap map = full_map();
    EditedMap edited(EditUse::kMatching);
    edited.take(map, {box(kind, 0.0, 0.64)}, nothing(map));
    EXPECT_EQ(cells_in(edited.of(map).occupied, 0.0, 0.64), 0U);
    EXPECT_EQ(cells_in(edited.of(map).passed, 0.0, 0.64), 0U);
    EXPECT_EQ(edited.of(map).occupied.size(), map.occupied.size() - 32 * 32 * 32);
    EXPECT_EQ(edited.of(map).passed.size(), map.passed.size() - 8 * 8 * 8);
  }
}

TEST(EditedMap, IsTheMapItselfForMatchingWhereABoxIsKeptBlocked) {
  const OccupancyMap map = full_map();
  EditedMap edited(EditUse::kMatching);
  edited.take(map, {box(EditKind::kKeepBlocked, 0.0, 4.0)}, nothing(map));
  EXPECT_EQ(&edited.of(map), &map);
  edited.take(map, {box(EditKind::kErase, 0.0, 0.64), box(EditKind::kKeepBlocked, 0.0, 4.0)},
              nothing(map));
  EXPECT_EQ(cells_in(edited.of(map).occupied, 0.0, 0.64), 0U) << "what was erased comes back";
}

TEST(EditedMap, TellsPlannersWhatIsKeptFreeOrBlockedThereAlone) {
  OccupancyMap map;
  map.occupied = VoxelMap(0.08);
  const Voxel hit = voxel_at(Eigen::Vector3d(0.3, 0.3, 0.3), 0.08);
  const Voxel passed = voxel_at(Eigen::Vector3d(0.5, 0.5, 0.5), 0.08);
  map.occupied.insert(hit);
  map.passed.insert(passed);
  const auto with = [&](EditKind kind) {
    EditedMap edited(EditUse::kPlanning);
    edited.take(map, {box(kind, 0.0, 0.64)}, nothing(map));
    return edited.of(map);
  };
  const OccupancyMap erased = with(EditKind::kErase), free = with(EditKind::kKeepFree),
                     blocked = with(EditKind::kKeepBlocked);
  EXPECT_TRUE(erased.occupied.empty());
  EXPECT_EQ(erased.passed.size(), 1U);
  EXPECT_TRUE(free.occupied.empty());
  EXPECT_EQ(free.passed.size(), 512U);
  EXPECT_EQ(blocked.occupied.size(), 512U);
  EXPECT_TRUE(blocked.passed.empty());
}

// A map in which blocks come, change and go, step by step.
class Growth {
 public:
  explicit Growth(std::uint32_t seed) : random_(seed) {}

  ChangedBlocks step(OccupancyMap& map) {
    ChangedBlocks changed;
    changed.from = map.revision();
    for (int i = 0; i < 20; ++i) {
      change(map.occupied, changed.occupied);
      change(map.passed, changed.passed);
    }
    changed.to = map.revision();
    return changed;
  }

 private:
  void change(VoxelMap& map, std::vector<Voxel>& changed) {
    std::uniform_int_distribution<int> at(-4, 3);
    const Voxel block{at(random_), at(random_), at(random_)};
    VoxelBlock bits{};
    if (random_() % 4 != 0)
      for (std::uint64_t& word : bits) word = random_() & random_();
    if (map.set_block(block, bits)) changed.push_back(block);
  }

  std::mt19937 random_;
};

std::vector<PlacedBox> boxes() {
  PlacedBox turned = box(EditKind::kKeepFree, 0.1, 0.9);
  turned.T_map_box = {-0.3, 0.2, 0.7};
  return {box(EditKind::kErase, -0.5, 0.2), turned, box(EditKind::kKeepBlocked, 0.3, 1.5)};
}

TEST(EditedMap, HasTheSameBitsFollowingAsMadeAnew) {
  for (const EditUse use : {EditUse::kMatching, EditUse::kPlanning}) {
    Growth growth(7);
    OccupancyMap map, copy;
    EditedMap edited(use);
    edited.take(map, boxes(), nothing(map));
    copy = edited.of(map);
    for (int i = 0; i < 20; ++i) {
      const ChangedBlocks changed = edited.follow(map, growth.step(map));
      EXPECT_EQ(changed.from, copy.revision());
      EXPECT_EQ(changed.to, edited.of(map).revision());
      const ChangedBlocks real = difference(copy, edited.of(map));
      for (const Voxel& block : real.occupied)
        EXPECT_EQ(std::ranges::count(changed.occupied, block), 1);
      for (const Voxel& block : real.passed)
        EXPECT_EQ(std::ranges::count(changed.passed, block), 1);
      copy = edited.of(map);
      EditedMap anew(use);
      anew.take(map, boxes(), nothing(map));
      EXPECT_EQ(copy.occupied.hash(), anew.of(map).occupied.hash());
      EXPECT_EQ(copy.passed.hash(), anew.of(map).passed.hash());
    }
    EXPECT_NE(copy.occupied.hash(), map.occupied.hash());
    EXPECT_NE(copy.passed.hash(), map.passed.hash());
  }
}

TEST(EditedMap, TellsWhatOtherBoxesChange) {
  const OccupancyMap map = full_map();
  EditedMap edited(EditUse::kMatching);
  edited.take(map, {box(EditKind::kErase, 0.0, 0.16)}, nothing(map));
  const ChangedBlocks changed = edited.take(map, {}, nothing(map));
  EXPECT_EQ(changed.occupied, (std::vector<Voxel>{{0, 0, 0}}));
  EXPECT_EQ(&edited.of(map), &map);
  EXPECT_EQ(changed.to, map.revision());
}

}  // namespace
}  // namespace voxlist
