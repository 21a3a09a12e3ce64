#include "voxlist/planning/grids/grid_builder.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/planning/grids/drawn_map.h"

namespace voxlist::planning {
namespace {

using test::DrawnMap;

std::vector<RobotProfile> robots() {
  std::vector<RobotProfile> robots(3);
  robots[0].height_m = 0.4;
  robots[1].height_m = 1.7;
  robots[2].step_m = 0.15;
  robots[2].radius_m = 0.2;
  return robots;
}

// A map to which something happens each time.
class Happenings {
 public:
  explicit Happenings(unsigned seed) : random_(seed) { drawn.floor({-30, -30}, {30, 30}); }

  void happen() {
    const int x = draw(-50, 50), y = draw(-50, 50), width = draw(1, 25), length = draw(1, 25);
    const Cell low{x, y}, high{x + width, y + length};
    switch (draw(0, 8)) {
      case 0:  // a floor at any height
        return drawn.floor(low, high, draw(-10, 60));
      case 1:  // about that of others
        return drawn.floor(low, high, draw(-3, 4));
      case 2:  // a ramp
        for (std::int32_t i = 0; i < width; ++i)
          drawn.floor({x + i, y}, {x + i + 1, high.y}, i / 2);
        return;
      case 3:  // something that stands or hangs
        return drawn.hit({{4 * x, 4 * y, draw(-2, 60)}, {4 * x + draw(1, 60), 4 * y + 9, 70}});
      case 4:  // rays
        return drawn.pass({{x, y, draw(-5, 2)}, {high.x, high.y, draw(3, 30)}});
      case 5:  // blocks that are carved out
      case 6:
        for (std::int32_t i = 0; i < 60; ++i) carve({x / 2 + i % 6, y / 2 + i / 6 % 5, i / 30 - 1});
        return;
      default:  // lines between which there is no floor
        for (std::int32_t i = 0; i < width; ++i)
          drawn.hit({{4 * x + 12 * i, 4 * y, -1}, {4 * x + 12 * i + 4, 4 * high.y, 1}});
        return drawn.pass({{x, y, 0}, {x + 3 * width, high.y, 20}});
    }
  }

  void drive() {
    way.emplace_back(0.08 * draw(-40, 40), 0.08 * draw(-40, 40), draw(0, 4) == 0 ? 0.3 : 0.0);
  }

  int draw(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<unsigned>(high - low));
  }

  DrawnMap drawn;
  std::vector<Eigen::Vector3d> way, since{{0.5, 0.5, 0.0}};

 private:
  void carve(const Voxel& block) {
    if (drawn.map.occupied.find_block(block)) drawn.map.occupied.set_block(block, {});
  }

  std::mt19937 random_;
};

void follow(GridBuilder& builder, const DrawnMap& before, const DrawnMap& now) {
  builder.follow(now.map, difference(before.map, now.map), now.free,
                 difference(before.free, now.free));
}

GridBuilder anew(const Happenings& world) {
  GridBuilder builder(robots());
  builder.take(world.drawn.map, world.drawn.free);
  builder.drive(world.way, {world.since});
  builder.update();
  return builder;
}

TEST(GridBuilder, HasTheSameGridsWhetherItFollowsOrBeginsAnew) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Happenings world(seed);
    GridBuilder followed = anew(world);
    for (int i = 0; i < 25; ++i) {
      const DrawnMap before = world.drawn;
      world.happen();
      if (i % 3 == 0) world.drive();
      if (i == 11) world.way.erase(world.way.begin());
      if (i == 17) world.way.clear(), world.since = {{-3.0, 0.5, 0.0}};
      follow(followed, before, world.drawn);
      followed.drive(world.way, {world.since});
      const auto grids = followed.grids();
      const auto changed = followed.update();
      const GridBuilder fresh = anew(world);
      ASSERT_EQ(*fresh.columns().bounds(), *followed.columns().bounds());
      for (std::size_t k = 0; k < fresh.grids().size(); ++k)
        ASSERT_TRUE(fresh.grids()[k] == followed.grids()[k])
            << "seed " << seed << ", happening " << i << ", robot " << k;
      EXPECT_EQ(changed.has_value(), grids != followed.grids()) << seed << ' ' << i;
    }
  }
}

TEST(GridBuilder, TellsNothingWhereNothingHasChanged) {
  Happenings world(1);
  GridBuilder builder = anew(world);
  EXPECT_FALSE(builder.update());
  world.drawn.hit({{40, 40, 0}, {44, 44, 30}});
  builder.follow(world.drawn.map, {{{5, 5, 0}}, {}}, world.drawn.free, {});
  const auto changed = builder.update();
  ASSERT_TRUE(changed);
  EXPECT_TRUE(changed->contains({10, 10}));
  EXPECT_FALSE(builder.update());
}

TEST(GridBuilder, HasNoGridsWithoutAMap) {
  GridBuilder builder(robots());
  EXPECT_FALSE(builder.update());
  EXPECT_TRUE(builder.grids().empty());
}

}  // namespace
}  // namespace voxlist::planning
