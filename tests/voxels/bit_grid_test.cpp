#include "voxlist/voxels/bit_grid.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace voxlist {
namespace {

TEST(BitGrid, HoldsWhatWasMarkedInItsBoxAndNothingElse) {
  std::mt19937 random(1);
  const auto voxel = [&] {
    const auto part = [&] { return static_cast<std::int32_t>(random() % 200) - 100; };
    return Voxel{part(), part(), part()};
  };
  // 128 x 60 x 70 voxels: whole words along x.
  BitGrid grid({-70, -30, -40}, 100, 60, 70);
  const auto within = [](const Voxel& v) {
    return v.x >= -70 && v.x < 58 && v.y >= -30 && v.y < 30 && v.z >= -40 && v.z < 30;
  };
  std::set<Voxel> marked;
  for (int i = 0; i < 20'000; ++i) {
    const Voxel v = voxel();
    grid.set(v);
    if (within(v)) marked.insert(v);
  }
  EXPECT_GT(marked.size(), 1000u);
  for (int i = 0; i < 20'000; ++i) {
    const Voxel v = voxel();
    EXPECT_EQ(grid.test(v), marked.contains(v));
  }
}

}  // namespace
}  // namespace voxlist
