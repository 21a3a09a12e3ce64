#include "voxlist/voxels/edits/edited_counters.h"

#include <gtest/gtest.h>

#include <random>

namespace voxlist {
namespace {

constexpr double kResolution_m = 0.1;

PlacedBox box(EditKind kind, double from_m, double to_m) {
  return {kind, {Eigen::Vector3d::Constant(from_m), Eigen::Vector3d::Constant(to_m)}};
}

BlockBits some(std::mt19937& random) {
  BlockBits bits{};
  for (std::uint64_t& word : bits) word = std::uint64_t{random()} << 32 | random();
  return bits;
}

// Counts a scan of some blocks.
void count(std::mt19937& random, CounterMap& map) {
  for (int i = 0; i < 6; ++i) {
    const auto at = [&] { return static_cast<std::int32_t>(random() % 4) - 2; };
    const Voxel block{at(), at(), at()};
    const BlockBits passed = some(random), hit = some(random);
    map.add(block, CellStore::Block(passed), CellStore::Block(hit));
  }
}

std::vector<PlacedBox> boxes() {
  return {box(EditKind::kErase, -1.2, 0.3), box(EditKind::kKeepFree, 0.1, 0.6),
          box(EditKind::kKeepBlocked, 0.5, 3.0)};
}

TEST(EditedCounters, AreTheSameFollowingAsMadeAnew) {
  std::mt19937 random(3);
  CounterMap map(kResolution_m);
  EditedCounters edited(map, boxes());
  for (int i = 0; i < 10; ++i) {
    count(random, map);
    edited.update(map, map.take_changed());
    EXPECT_EQ(edited.map().hash(), EditedCounters(map, boxes()).map().hash());
    EXPECT_NE(edited.map().hash(), map.hash());
  }
}

TEST(EditedCounters, ForgetHitsAndKeepWhatIsToBeFreeOrBlocked) {
  std::mt19937 random(4);
  CounterMap map(kResolution_m);
  for (int i = 0; i < 10; ++i) count(random, map);
  const EditedCounters edited(map, boxes());
  std::array<int, 3> erased{};
  for (int i = 0; i < 40 * 40 * 40; ++i) {
    const Voxel cell{i % 40 - 15, i / 40 % 40 - 15, i / 1600 - 15};
    const Eigen::Vector3d at = center(cell, kResolution_m);
    const CellState before = map.at(cell), after = edited.map().at(cell);
    if (at.minCoeff() > 0.5 && at.maxCoeff() < 3.0) {
      EXPECT_EQ(after, CellState::kOccupied);
      EXPECT_EQ(edited.map().count_at(cell), map.rule().highest);
    } else if (at.minCoeff() > 0.1 && at.maxCoeff() < 0.6) {
      EXPECT_EQ(edited.map().count_at(cell), map.rule().lowest);
    } else if (at.minCoeff() > -1.2 && at.maxCoeff() < 0.3) {
      ++erased[static_cast<std::size_t>(before)];
      EXPECT_EQ(after, before == CellState::kFree ? before : CellState::kUnknown);
    } else {
      EXPECT_EQ(after, before);
    }
  }
  for (const int cells : erased) EXPECT_GT(cells, 50);
}

}  // namespace
}  // namespace voxlist
