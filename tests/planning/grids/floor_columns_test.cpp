#include "voxlist/planning/grids/floor_columns.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/planning/grids/drawn_map.h"

namespace voxlist::planning {
namespace {

using test::DrawnMap;

void expect_alike(const FloorColumns& a, const FloorColumns& b) {
  ASSERT_TRUE(a.bounds() && b.bounds());
  ASSERT_EQ(*a.bounds(), *b.bounds());
  for (std::int32_t y = a.bounds()->low.y; y < a.bounds()->high.y; ++y)
    for (std::int32_t x = a.bounds()->low.x; x < a.bounds()->high.x; ++x) {
      const Column one = a.at({x, y}), other = b.at({x, y});
      ASSERT_EQ(one.spans.size(), other.spans.size()) << x << ' ' << y;
      ASSERT_EQ(one.free.size(), other.free.size()) << x << ' ' << y;
      for (std::size_t i = 0; i < one.spans.size(); ++i) {
        EXPECT_EQ(one.spans[i].bottom, other.spans[i].bottom);
        EXPECT_EQ(one.spans[i].top, other.spans[i].top);
        EXPECT_EQ(one.spans[i].surface_m, other.spans[i].surface_m);
        EXPECT_EQ(one.spans[i].kink_m, other.spans[i].kink_m) << x << ' ' << y;
      }
    }
}

TEST(FloorColumns, HasWhatStandsWithoutAGapAsOneSpan) {
  DrawnMap drawn;
  drawn.hit({{0, 0, -1}, {4, 4, 1}});
  drawn.hit({{0, 0, 35}, {4, 4, 37}});
  drawn.pass({{0, 0, 0}, {1, 1, 8}});
  const FloorColumns columns = drawn.columns();
  const Column column = columns.at({0, 0});
  ASSERT_EQ(column.spans.size(), 2u);
  EXPECT_EQ(column.spans[0].bottom, -1);
  EXPECT_EQ(column.spans[0].top, 1);
  EXPECT_NEAR(column.spans[0].surface_m, 0.0, 1e-6);
  EXPECT_EQ(column.spans[1].bottom, 35);
  EXPECT_NEAR(column.spans[1].surface_m, 0.72, 1e-6);
  ASSERT_EQ(column.free.size(), 1u);
  EXPECT_EQ(column.free[0].bottom, 0);
  EXPECT_EQ(column.free[0].top, 8);
  EXPECT_TRUE(columns.at({1, 0}).spans.empty());
  EXPECT_TRUE(columns.at({100, 0}).spans.empty());
}

TEST(FloorColumns, TellsAFloorsHeightByHowManyVoxelsItsLayersHave) {
  DrawnMap drawn;
  drawn.hit({{0, 0, 0}, {4, 4, 1}});
  drawn.hit({{0, 0, 1}, {1, 4, 2}});
  EXPECT_NEAR(drawn.columns().at({0, 0}).spans[0].surface_m, (0.01 * 16 + 0.03 * 4) / 20, 1e-6);
}

TEST(FloorColumns, LeaveOutSpecksAboveAFloorAndNothingElse) {
  DrawnMap drawn;
  drawn.hit({{0, 0, -1}, {12, 4, 1}});
  drawn.hit({{1, 1, 3}, {2, 2, 4}});
  drawn.hit({{5, 1, 3}, {6, 2, 4}});
  drawn.hit({{5, 1, 5}, {6, 2, 9}});
  drawn.hit({{9, 1, 8}, {10, 2, 9}});
  drawn.hit({{12, 0, -1}, {13, 1, 0}});
  drawn.hit({{13, 0, 2}, {14, 1, 3}});
  drawn.hit({{16, 0, -1}, {20, 4, 0}});
  drawn.hit({{16, 0, 2}, {20, 4, 3}});
  const FloorColumns columns = drawn.columns();
  EXPECT_EQ(columns.at({0, 0}).spans.size(), 1u);
  EXPECT_EQ(columns.at({1, 0}).spans.size(), 3u) << "something thin stands there";
  EXPECT_EQ(columns.at({2, 0}).spans.size(), 2u) << "too high for a speck";
  EXPECT_EQ(columns.at({3, 0}).spans.size(), 1u) << "a floor that was hit twice";
  EXPECT_EQ(columns.at({4, 0}).spans.size(), 2u) << "something flat lies there";
}

TEST(FloorColumns, AreTheSameWhetherTheyFollowOrAreMadeAnew) {
  std::mt19937 random(7);
  const auto draw = [&](int low, int high) {
    return low + static_cast<int>(random() % static_cast<unsigned>(high - low));
  };
  DrawnMap drawn;
  drawn.floor({-20, -20}, {20, 20});
  FloorColumns followed = drawn.columns();
  for (int i = 0; i < 20; ++i) {
    const DrawnMap before = drawn;
    const Voxel at{draw(-100, 100), draw(-100, 100), draw(-10, 100)};
    drawn.hit({at, {at.x + draw(1, 20), at.y + draw(1, 20), at.z + draw(1, 20)}});
    drawn.map.occupied.set_block({draw(-10, 10), draw(-10, 10), 0}, VoxelBlock{});
    drawn.pass({{at.x / 4, at.y / 4, 0}, {at.x / 4 + 3, at.y / 4 + 3, 3}});
    followed.follow(drawn.map, difference(before.map, drawn.map), drawn.free,
                    difference(before.free, drawn.free));
    expect_alike(followed, drawn.columns());
  }
}

}  // namespace
}  // namespace voxlist::planning
