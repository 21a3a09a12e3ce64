#include "voxlist/simulation/building/building.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "voxlist/simulation/random.h"
#include "voxlist/simulation/world/tour.h"

namespace voxlist::simulation {
namespace {

using Eigen::Vector3d;

double range(const Building& building, const Vector3d& origin, const Vector3d& direction) {
  return building.solid.range(origin, direction).value();
}

TEST(Building, IsABoxOfTheConfiguredSizeWithoutRoomsAndFurniture) {
  BuildingConfig config;
  config.rooms = 0;
  config.furniture_per_room = 0;
  const Building building = make_building(config);
  const Vector3d eye{0.0, 0.0, 1.0};
  EXPECT_NEAR(range(building, eye, -Vector3d::UnitZ()), 1.0, 1e-12);
  EXPECT_NEAR(range(building, eye, Vector3d::UnitZ()), 1.6, 1e-12);
  EXPECT_NEAR(range(building, eye, -Vector3d::UnitX()), 1.0, 1e-12);
  EXPECT_NEAR(range(building, eye, Vector3d::UnitX()), 15.0, 1e-12);
  EXPECT_NEAR(range(building, eye, Vector3d::UnitY()), 1.1, 1e-12);
  EXPECT_NEAR(range(building, eye, -Vector3d::UnitY()), 1.1, 1e-12);
}

TEST(Building, HasTheRoomsAskedForEachWithADoorUnderALintel) {
  const Building building = make_building({});
  ASSERT_EQ(building.rooms.size(), 6u);
  for (const Room& room : building.rooms) {
    EXPECT_NEAR(building.clearance_m(room.door, 0.02, 2.0), 0.5, 1e-9);
    EXPECT_NEAR(range(building, {room.door.x(), room.door.y(), 1.0}, Vector3d::UnitZ()), 1.1,
                1e-12);
  }
}

TEST(Building, LetsNoRayOut) {
  const Building building = make_building({});
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const Vector3d direction = Vector3d(x, y, z).normalized();
    const auto found = building.solid.range({0.0, 0.0, 1.0}, direction);
    ASSERT_TRUE(found) << direction.transpose();
    EXPECT_LT(*found, 20.5);
  }
}

TEST(Building, IsFurnishedWithThingsThatStandAndTopsThatHang) {
  BuildingConfig config;
  const Building furnished = make_building(config);
  config.furniture_per_room = 0;
  const Building empty = make_building(config);
  EXPECT_GT(furnished.solid.boxes().size(), empty.solid.boxes().size() + 20);
  EXPECT_TRUE(std::any_of(furnished.solid.boxes().begin(), furnished.solid.boxes().end(),
                          [](const Box& b) { return b.bottom_m() > 0.5 && b.top_m() < 1.0; }));
}

TEST(Building, IsTheSameForASeedAndAnotherForAnother) {
  BuildingConfig config;
  const auto made = [&config] {
    std::vector<Vector3d> centres;
    const Building building = make_building(config);
    for (const Box& box : building.solid.boxes()) centres.push_back(box.centre_m);
    return centres;
  };
  const auto first = made();
  EXPECT_EQ(first, made());
  config.seed = 2;
  EXPECT_NE(first, made());
}

TEST(Building, RefusesMoreRoomsThanFit) {
  BuildingConfig config;
  config.rooms = 20;
  EXPECT_THROW(make_building(config), std::invalid_argument);
  config.rooms = -1;
  EXPECT_THROW(make_building(config), std::invalid_argument);
}

BuildingConfig with_stairs(int stairs) {
  BuildingConfig config;
  config.stairs = stairs;
  return config;
}

TEST(Building, HasStairsThatGoDownStepByStepThroughAHoleInTheFloor) {
  for (int seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    BuildingConfig config = with_stairs(1);
    config.seed = seed;
    const Building building = make_building(config);
    ASSERT_EQ(building.holes.size(), 1u);
    const Rectangle& hole = building.holes.front();
    const double y = (hole.low.y() + hole.high.y()) / 2.0;
    std::vector<double> depths;
    for (double x = hole.low.x() + 0.05; x < hole.high.x(); x += 0.1)
      depths.push_back(range(building, {x, y, 0.1}, -Vector3d::UnitZ()) - 0.1);
    if (depths.front() > depths.back()) std::reverse(depths.begin(), depths.end());
    EXPECT_NEAR(depths.front(), 0.18, 1e-9);
    EXPECT_NEAR(depths.back(), 8 * 0.18, 1e-9);
    EXPECT_TRUE(std::is_sorted(depths.begin(), depths.end()));
  }
}

TEST(Building, LetsNoRayOutThroughItsStairs) {
  const Building building = make_building(with_stairs(2));
  Random random(4);
  for (const Rectangle& hole : building.holes)
    for (int i = 0; i < 1000; ++i) {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
      const Vector3d eye((hole.low.x() + hole.high.x()) / 2.0, (hole.low.y() + hole.high.y()) / 2.0,
                         0.1);
      const auto found = building.solid.range(eye, Vector3d(x, y, z).normalized());
      ASSERT_TRUE(found);
      EXPECT_LT(*found, 20.5);
    }
}

TEST(Building, HasAFloorAroundItsStairsAndNoFurnitureOverThem) {
  const Building building = make_building(with_stairs(2));
  Random random(5);
  const auto in_a_hole = [&building](const Eigen::Vector2d& point) {
    return std::any_of(building.holes.begin(), building.holes.end(),
                       [&](const Rectangle& hole) { return hole.distance_m(point) <= 0.0; });
  };
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(-0.9, 14.9), y = random.uniform(-5.9, 5.9);
    const double height = 2.5 - range(building, {x, y, 2.5}, -Vector3d::UnitZ());
    EXPECT_EQ(height < -0.1, in_a_hole({x, y})) << x << " " << y << " " << height;
  }
}

TEST(Building, CountsItsHolesAsObstaclesAndLeavesItsToursAround) {
  const Building building = make_building(with_stairs(2));
  ASSERT_EQ(building.holes.size(), 2u);
  const Rectangle& hole = building.holes[1];
  EXPECT_EQ(building.clearance_m((hole.low + hole.high) / 2.0, 0.02, 1.0), 0.0);
  for (const Eigen::Vector2d& point : plan_tour(building, {}))
    for (const Rectangle& h : building.holes) EXPECT_GE(h.distance_m(point), 0.37 - 1e-9);
}

TEST(Building, HasPipesAcrossCornersAndUnderTheCorridorsCeiling) {
  BuildingConfig config;
  const std::size_t without = make_building(config).solid.boxes().size();
  config.pipes = 3;
  const Building building = make_building(config);
  EXPECT_EQ(building.solid.boxes().size(), without + 4);
  int at_head_height = 0;
  for (const Box& box : building.solid.boxes())
    if (box.bottom_m() > 1.1 && box.top_m() < 1.7 && box.half_m.y() < 0.05) ++at_head_height;
  EXPECT_EQ(at_head_height, 3);
  EXPECT_LT(range(building, {1.0, 0.5, 2.0}, Vector3d::UnitZ()), 0.4);
}

std::vector<double> box_numbers(const BuildingConfig& config) {
  std::vector<double> numbers;
  const Building building = make_building(config);
  for (const Box& box : building.solid.boxes())
    numbers.push_back(box.centre_m.x() + 100.0 * box.centre_m.y() + 1e4 * box.centre_m.z() +
                      1e6 * box.half_m.prod());
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::size_t common(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both.size();
}

TEST(Building, IsTheSameLaterButForSomeFurniture) {
  BuildingConfig config;
  const auto before = box_numbers(config);
  config.furniture_per_room = 0;
  const auto bare = box_numbers(config);
  config = {};
  config.changed = 1;
  const auto after = box_numbers(config);
  EXPECT_EQ(after, box_numbers(config));
  EXPECT_EQ(common(after, bare), bare.size());  // walls and doors stay
  const double furniture = static_cast<double>(before.size() - bare.size());
  const double same = static_cast<double>(common(before, after) - bare.size());
  EXPECT_GT(same, 0.4 * furniture);
  EXPECT_LT(same, 0.9 * furniture);
  EXPECT_GT(after.size(), bare.size() + static_cast<std::size_t>(same));
  config.changed = 2;
  EXPECT_NE(after, box_numbers(config));
}

TEST(Building, RefusesMoreStairsThanFit) {
  EXPECT_THROW(make_building(with_stairs(100)), std::invalid_argument);
}

}  // namespace
}  // namespace voxlist::simulation
