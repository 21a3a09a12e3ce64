#include "simulation/building.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "simulation/random.h"

namespace voxlist {
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

}  // namespace
}  // namespace voxlist
