#include "voxlist/voxels/numbering.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace voxlist {
namespace {

TEST(Numbering, AgreesWithAnOrderedMapOnRandomVoxels) {
  std::mt19937 random(1);
  const auto coordinate = [&] { return static_cast<std::int32_t>(random() % 40) - 20; };
  Numbering<Voxel> numbering;
  std::map<Voxel, std::uint32_t> reference;
  for (int i = 0; i < 20'000; ++i) {
    const Voxel v{coordinate(), coordinate(), coordinate()};
    const auto next = static_cast<std::uint32_t>(reference.size());
    EXPECT_EQ(numbering.number(v), reference.try_emplace(v, next).first->second);
  }
  ASSERT_EQ(numbering.size(), reference.size());
  for (const auto& [voxel, number] : reference) {
    EXPECT_EQ(numbering.find(voxel), number);
    EXPECT_EQ(numbering.key(number), voxel);
  }
  EXPECT_EQ(numbering.find({99, 0, 0}), Numbering<Voxel>::kNone);
}

TEST(Numbering, TellsVoxelsApartWhoseKeysAreTheSame) {
  const Voxel near{1, 2, 3}, far{1 + (1 << 21), 2, 3};
  ASSERT_EQ(key_of(near), key_of(far));
  Numbering<Voxel> numbering;
  EXPECT_EQ(numbering.number(near), 0u);
  EXPECT_EQ(numbering.find(far), Numbering<Voxel>::kNone);
  EXPECT_EQ(numbering.number(far), 1u);
}

TEST(Numbering, BeginsAnewWhenCleared) {
  Numbering numbering(1000);
  EXPECT_EQ(numbering.number(7), 0u);
  EXPECT_EQ(numbering.number(8), 1u);
  numbering.clear();
  EXPECT_EQ(numbering.size(), 0u);
  EXPECT_EQ(numbering.find(7), Numbering<>::kNone);
  EXPECT_EQ(numbering.number(8), 0u);
}

}  // namespace
}  // namespace voxlist
