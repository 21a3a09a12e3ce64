#include "voxlist/voxels/counters/mark_rays.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

#include "tests/system/instruction_sets.h"
#include "tests/voxels/counters/exact_walk.h"
#include "voxlist/voxels/counters/cell_store.h"
#include "voxlist/voxels/voxel_ray.h"

namespace voxlist {
namespace {

constexpr std::uint32_t kSeed = 20'260'514;
// The largest box along x: blocks along each side, in bits.
constexpr int kSides[3] = {kBoxBits - 3, 8, 7};
constexpr int kBlockBits = kSides[0] + kSides[1] + kSides[2];
constexpr int kShifts[3] = {kBlockKeyBits, kBlockKeyBits + kSides[0],
                            kBlockKeyBits + kSides[0] + kSides[1]};

RayJob job_of(const std::vector<FixedRay>& rays, CellStore& store) {
  return {rays.data(), rays.size(), {kShifts[0], kShifts[1], kShifts[2]}, &store.bits()};
}

// The cells that are marked in the box.
class Marked {
 public:
  std::set<Voxel> cells(const std::vector<FixedRay>& rays, Instructions instructions) {
    store_.begin(kBlockBits, 100'000);
    mark_rays(job_of(rays, store_), instructions);
    EXPECT_FALSE(store_.bits().is_full);
    std::set<Voxel> cells;
    for (std::uint32_t i = kFirstPlace; i < store_.end(); ++i) add(i, cells);
    return cells;
  }

 private:
  void add(std::uint32_t place, std::set<Voxel>& cells) const {
    const std::uint32_t block = store_.block(place);
    const auto corner = [&](int axis) {
      const std::uint32_t number = block >> (kShifts[axis] - kBlockKeyBits);
      return static_cast<std::int32_t>(number & ((1u << kSides[axis]) - 1)) * 8;
    };
    for (std::size_t bit = 0; bit < 512; ++bit) {
      if ((store_.words(place)[bit / 64] >> bit % 64 & 1) == 0) continue;
      const Voxel in_block = cell_of_bit(bit);
      cells.insert({corner(0) + in_block.x, corner(1) + in_block.y, corner(2) + in_block.z});
    }
  }

  CellStore store_;
};

// Ends anywhere in a cube of cells, or on the edges of its cells.
class RandomRays {
 public:
  explicit RandomRays(std::int32_t cells) : fraction_(0, (cells << kFractionBits) - 1) {}

  FixedRay any() {
    return ray([&] { return fraction_(random_); });
  }
  FixedRay between_corners() {
    return ray([&] { return fraction_(random_) >> kFractionBits << kFractionBits; });
  }
  // Ends on halves of cells, so that faces are often crossed at once.
  FixedRay between_halves() {
    return ray([&] { return fraction_(random_) >> (kFractionBits - 1) << (kFractionBits - 1); });
  }

 private:
  template <class Coordinate>
  static FixedRay ray(const Coordinate& coordinate) {
    FixedRay ray;
    for (std::int32_t& c : ray.from) c = coordinate();
    for (std::int32_t& c : ray.to) c = coordinate();
    return ray;
  }

  std::mt19937 random_{kSeed};
  std::uniform_int_distribution<std::int32_t> fraction_;
};

void expect_exact(const FixedRay& ray, Marked& marked) {
  const std::set<Voxel> expected = exact_walk(ray);
  for (const Instructions instructions : instruction_sets())
    ASSERT_EQ(marked.cells({ray}, instructions), expected)
        << static_cast<int>(instructions) << ": " << ray.from[0] << ' ' << ray.from[1] << ' '
        << ray.from[2] << " to " << ray.to[0] << ' ' << ray.to[1] << ' ' << ray.to[2];
}

TEST(MarkRays, MarksExactlyTheCellsOfASlowWalk) {
  SCOPED_TRACE(kSeed);
  Marked marked;
  for (const std::int32_t cells : {2, 9, 100, 1000}) {
    RandomRays random(cells);
    for (int i = 0; i < 3000 / cells + 100; ++i) expect_exact(random.any(), marked);
  }
}

TEST(MarkRays, IsExactWhereFacesAreCrossedAtOnce) {
  SCOPED_TRACE(kSeed);
  Marked marked;
  for (const std::int32_t cells : {2, 5, 12, 40}) {
    RandomRays random(cells);
    for (int i = 0; i < 400; ++i) {
      expect_exact(random.between_corners(), marked);
      expect_exact(random.between_halves(), marked);
    }
  }
}

TEST(MarkRays, MarksTheSameEitherWay) {
  SCOPED_TRACE(kSeed);
  Marked marked;
  RandomRays random(60);
  for (int i = 0; i < 200; ++i) {
    const FixedRay ray = i % 2 == 0 ? random.any() : random.between_halves();
    FixedRay back;
    std::copy(ray.from, ray.from + 3, back.to);
    std::copy(ray.to, ray.to + 3, back.from);
    for (const Instructions instructions : instruction_sets())
      ASSERT_EQ(marked.cells({ray}, instructions), marked.cells({back}, instructions));
  }
}

// The walk through the lattice of the matcher's maps, in doubles, cell by cell.
TEST(MarkRays, MarksWhatTheWalkInDoublesVisits) {
  SCOPED_TRACE(kSeed);
  Marked marked;
  RandomRays random(400);
  std::size_t alike = 0, all = 0;
  for (int i = 0; i < 200; ++i) {
    const FixedRay ray = random.any();
    const auto end = [](const std::int32_t at[3]) -> Eigen::Vector3d {
      constexpr double kCell = 1.0 / (1 << kFractionBits);
      return {at[0] * kCell, at[1] * kCell, at[2] * kCell};
    };
    const std::set<Voxel> cells = marked.cells({ray}, best_instructions());
    visit_ray(end(ray.from), end(ray.to), 1.0, [&](const Voxel& cell) {
      alike += cells.count(cell);
      ++all;
      return true;
    });
  }
  EXPECT_GT(all, 50'000u);
  EXPECT_GE(alike + 2, all);
}

TEST(MarkRays, GoesFromEndToEndOfTheBoxTheSameWithAllInstructions) {
  SCOPED_TRACE(kSeed);
  Marked marked;
  RandomRays random(1 << kBoxBits);
  for (int i = 0; i < 30; ++i) {
    FixedRay ray = random.any();
    for (int axis = 1; axis < 3; ++axis) {
      ray.from[axis] >>= kSides[0] - kSides[axis];
      ray.to[axis] >>= kSides[0] - kSides[axis];
    }
    const std::set<Voxel> expected = marked.cells({ray}, Instructions::kPortable);
    std::size_t faces = 1;
    for (int axis = 0; axis < 3; ++axis)
      faces += static_cast<std::size_t>(
          std::abs((ray.to[axis] >> kFractionBits) - (ray.from[axis] >> kFractionBits)));
    EXPECT_EQ(expected.size(), faces);
    for (const Instructions instructions : instruction_sets())
      ASSERT_EQ(marked.cells({ray}, instructions), expected);
  }
}

TEST(MarkRays, SaysWhenBlocksFindNoRoom) {
  for (const Instructions instructions : instruction_sets()) {
    CellStore store;
    store.begin(kBlockBits, 3);
    std::vector<FixedRay> ray{{{0, 0, 0}, {(24 << kFractionBits) - 1, 0, 0}}};
    mark_rays(job_of(ray, store), instructions);
    EXPECT_FALSE(store.bits().is_full);
    EXPECT_EQ(store.end(), kFirstPlace + 3);
    ++ray[0].to[0];
    mark_rays(job_of(ray, store), instructions);
    EXPECT_TRUE(store.bits().is_full);
    EXPECT_EQ(store.end(), kFirstPlace + 3);
  }
}

}  // namespace
}  // namespace voxlist
