#include "voxlist/matching/counting/dilated_map.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace voxlist::matching {
namespace {

// The cells of a dilated map by its header's words, counted from the world's origin.
std::set<Voxel> dilated_cells(const VoxelMap& map, std::int32_t factor) {
  std::set<Voxel> cells;
  map.for_each_voxel([&](const Voxel& v) {
    const Voxel c{floor_div(v.x, factor), floor_div(v.y, factor), floor_div(v.z, factor)};
    for (const Voxel& d : {Voxel{0, 0, 0}, Voxel{1, 0, 0}, Voxel{-1, 0, 0}, Voxel{0, 1, 0},
                           Voxel{0, -1, 0}, Voxel{0, 0, 1}, Voxel{0, 0, -1}})
      cells.insert({c.x + d.x, c.y + d.y, floor_div(c.z + d.z, 2)});
  });
  return cells;
}

bool occupied(const DilatedMap& map, const Voxel& cell) {
  const Voxel& low = map.lowest();
  return map.window_anywhere(cell.x - low.x, cell.y - low.y, cell.z - low.z) & 1;
}

VoxelMap random_map(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int32_t> place(-30, 30), height(-9, 9);
  VoxelMap map;
  for (int i = 0; i < 60; ++i) map.insert({place(random), place(random), height(random)});
  return map;
}

TEST(DilatedMap, GrowsByFacesOnlyInLayersTwiceAsHigh) {
  VoxelMap voxel;
  voxel.insert({-3, 5, -1});  // cell (-2, 2, -1) of 0.04 m: the upper half of layer -1
  const DilatedMap map(voxel, 0.04, 1.0);
  EXPECT_DOUBLE_EQ(map.layer_m(), 0.08);
  const std::set<Voxel> expected{{-2, 2, -1}, {-2, 2, 0},  {-3, 2, -1},
                                 {-1, 2, -1}, {-2, 1, -1}, {-2, 3, -1}};
  EXPECT_EQ(dilated_cells(voxel, 2), expected);
  for (std::int32_t x = -12; x < 12; ++x)
    for (std::int32_t y = -12; y < 12; ++y)
      for (std::int32_t z = -4; z < 4; ++z)
        ASSERT_EQ(occupied(map, {x, y, z}), expected.contains({x, y, z}))
            << x << ' ' << y << ' ' << z;
  EXPECT_EQ(map.occupied_cells(), 6);
}

TEST(DilatedMap, HoldsTheCellsThatItsHeaderSays) {
  for (const std::int32_t factor : {1, 2, 3, 4}) {
    const VoxelMap voxels = random_map(static_cast<unsigned>(factor));
    const DilatedMap map(voxels, 0.02 * factor, 1.0);
    const std::set<Voxel> expected = dilated_cells(voxels, factor);
    EXPECT_EQ(map.occupied_cells(), static_cast<std::int64_t>(expected.size()));
    for (const Voxel& cell : expected)
      ASSERT_TRUE(occupied(map, cell))
          << factor << ": " << cell.x << ' ' << cell.y << ' ' << cell.z;
  }
}

TEST(DilatedMap, WindowsTellTheirCellsAtEachBlurAlsoBeyondTheBox) {
  constexpr std::int32_t kReach = 10;  // cells
  const VoxelMap voxels = random_map(7);
  const DilatedMap map(voxels, 0.04, kReach * 0.04);
  const std::set<Voxel> cells = dilated_cells(voxels, 2);
  const auto blurred = [&](const Voxel& cell, std::int32_t blur) {
    for (std::int32_t dx = 0; dx < 1 << blur; ++dx)
      for (std::int32_t dy = 0; dy < 1 << blur; ++dy)
        if (cells.contains({cell.x + dx, cell.y + dy, cell.z})) return true;
    return false;
  };
  for (std::int32_t blur = 0; blur < DilatedMap::kBlurs; ++blur)
    for (std::int32_t z = 0; z < map.size_z(); ++z)
      for (std::int32_t x = -kReach; x < map.size_x() + kReach; x += 3)
        for (std::int32_t y = -kReach; y < map.size_y() + kReach; ++y) {
          std::uint64_t expected = 0;
          for (std::int32_t i = 0; i < 8; ++i)
            for (std::int32_t k = 0; k < 8; ++k) {
              const Voxel cell{x + i + map.lowest().x, y + k + map.lowest().y, z + map.lowest().z};
              expected |= std::uint64_t{blurred(cell, blur)} << (8 * i + k);
            }
          ASSERT_EQ(map.window(map.place(x, y, z, blur), 0), expected)
              << x << ' ' << y << ' ' << z << ", blur " << blur;
          if (blur == 0) {
            ASSERT_EQ(map.window_anywhere(x, y, z), expected) << x << ' ' << y << ' ' << z;
          }
        }
}

TEST(DilatedMap, PlacesMoveByWholeWindows) {
  const DilatedMap map(random_map(9), 0.04, 1.0);
  for (std::int32_t x = -8; x < 8; x += 3)
    for (std::int32_t y = -8; y < 8; y += 3)
      for (std::int32_t wx = -1; wx <= 1; ++wx)
        for (std::int32_t wy = -1; wy <= 1; ++wy)
          ASSERT_EQ(map.window(map.place(x, y, 1, 0), map.moved(wx, wy)),
                    map.window_anywhere(x + 8 * wx, y + 8 * wy, 1));
}

TEST(DilatedMap, NothingIsFarOutside) {
  const DilatedMap map(random_map(7), 0.04, 1.0);
  for (const std::int32_t far : {-100'000, 100'000}) {
    EXPECT_EQ(map.window_anywhere(far, 0, 0), 0u);
    EXPECT_EQ(map.window_anywhere(0, far, 0), 0u);
    EXPECT_EQ(map.window_anywhere(0, 0, far), 0u);
  }
}

TEST(DilatedMap, FindsTheLayerOfAHeight) {
  const VoxelMap voxels = random_map(8);
  const DilatedMap map(voxels, 0.04, 1.0);
  EXPECT_EQ(map.layer(0.0), -map.lowest().z);
  EXPECT_EQ(map.layer(-0.001), -map.lowest().z - 1);
  EXPECT_EQ(map.layer(0.081), -map.lowest().z + 1);
  EXPECT_LT(map.layer(-9.0), 0);
  EXPECT_GE(map.layer(9.0), map.size_z());
}

TEST(DilatedMap, FillTellsFloorsFromWalls) {
  VoxelMap room;
  for (std::int32_t x = 0; x < 100; ++x)
    for (std::int32_t y = 0; y < 100; ++y) {
      room.insert({x, y, 1});  // floor in the middle of layer 0
      if (x == 50)
        for (std::int32_t z = 1; z < 60; ++z) room.insert({x, y, z});
    }
  const DilatedMap map(room, 0.04, 1.0);
  EXPECT_DOUBLE_EQ(map.fill(map.layer(0.03)), 1.0);
  EXPECT_NEAR(map.fill(map.layer(0.5)), 3.0 / 50.0, 0.01);
  EXPECT_EQ(map.fill(-1), 0.0);
  EXPECT_EQ(map.fill(map.size_z()), 0.0);
}

TEST(DilatedMap, IsEmptyForAnEmptyMap) {
  const DilatedMap map(VoxelMap(), 0.04, 1.0);
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.occupied_cells(), 0);
  EXPECT_EQ(map.window_anywhere(0, 0, 0), 0u);
}

}  // namespace
}  // namespace voxlist::matching
