#include "voxlist/planning/grids/typed_grid.h"

#include <gtest/gtest.h>

#include "tests/planning/grids/drawn_map.h"
#include "voxlist/planning/grids/grid_builder.h"

namespace voxlist::planning {
namespace {

using test::DrawnMap;

RobotProfile robot(double height_m) {
  RobotProfile robot;
  robot.height_m = height_m;
  return robot;
}

const RobotProfile kLow = robot(0.4), kTall = robot(1.7);

// A robot that drove at the middle of cell (1, 1).
TypedGrid grid_of(const DrawnMap& drawn, const RobotProfile& robot, double height_m = 0.0) {
  const FloorColumns columns = drawn.columns();
  DrivenCells driven;
  driven.drive({{{0.12, 0.12, height_m}}});
  Flood flood(robot.step_m);
  flood.follow(columns, {}, driven, driven.take_changes());
  const CellBox& all = *columns.bounds();
  return type_cells(columns, Ground(columns, flood, all), robot, all);
}

class TypedFloor : public ::testing::Test {
 protected:
  TypedFloor() { drawn_.floor({-10, -10}, {30, 30}); }

  CellType at(std::int32_t x, std::int32_t y, const RobotProfile& robot = kTall) const {
    return grid_of(drawn_, robot).at({x, y});
  }

  DrawnMap drawn_;
};

TEST_F(TypedFloor, IsFreeWhereItWasSeenAndNothingIsAbove) {
  EXPECT_EQ(at(1, 1), CellType::kFree);
  EXPECT_EQ(at(29, 29), CellType::kFree);
}

TEST_F(TypedFloor, IsUnknownWhereNothingWasSeen) {
  drawn_.floor({60, 0}, {70, 10});
  EXPECT_EQ(at(45, 5), CellType::kUnknown);
  EXPECT_EQ(at(65, 5), CellType::kUnknown) << "no way there was seen";
}

TEST_F(TypedFloor, IsUnknownWhereNoRayPassedAboveIt) {
  drawn_.hit({{40 * 4, 0, -1}, {44 * 4, 40, 1}});
  drawn_.floor({30, 0}, {40, 10});
  EXPECT_EQ(at(39, 5), CellType::kFree);
  EXPECT_EQ(at(42, 5), CellType::kUnknown);
}

TEST_F(TypedFloor, HasObstaclesOfEveryRobotWhereSomethingStands) {
  drawn_.hit({{40, 40, 0}, {44, 44, 30}});
  for (const RobotProfile& robot : {kLow, kTall}) {
    EXPECT_EQ(at(10, 10, robot), CellType::kObstacle);
    EXPECT_EQ(at(12, 10, robot), CellType::kFree);
  }
}

TEST_F(TypedFloor, IsFreeUnderATableForALowRobotAlone) {
  drawn_.hit({{40, 40, 35}, {60, 60, 37}});
  EXPECT_EQ(at(12, 12, kLow), CellType::kFree);
  EXPECT_EQ(at(12, 12, kTall), CellType::kOverhang);
}

TEST_F(TypedFloor, HasOverhangsAsThinAsAPipe) {
  drawn_.hit({{40, -40, 65}, {42, 120, 67}});
  EXPECT_EQ(at(10, 12, kLow), CellType::kFree);
  EXPECT_EQ(at(10, 12, kTall), CellType::kOverhang);
  EXPECT_EQ(at(11, 12, kTall), CellType::kFree);
}

TEST_F(TypedFloor, TakesATopThatRaysMeetInLinesToGoOnBetween) {
  for (std::int32_t x = 40; x < 80; x += 16) drawn_.hit({{x, 40, 35}, {x + 1, 80, 36}});
  EXPECT_EQ(at(12, 15), CellType::kOverhang);
  EXPECT_EQ(at(12, 15, kLow), CellType::kFree);
  EXPECT_EQ(at(8, 15), CellType::kFree);
  EXPECT_EQ(at(21, 15), CellType::kFree);
}

TEST_F(TypedFloor, LeavesTheGapThatARobotFitsThrough) {
  for (const std::int32_t x : {40, 80}) drawn_.hit({{x, 40, 35}, {x + 1, 80, 36}});
  EXPECT_EQ(at(15, 15), CellType::kFree);
}

TEST_F(TypedFloor, IsFreeUnderWhatHangsAboveTheClearance) {
  drawn_.hit({{40, 40, 90}, {60, 60, 92}});
  EXPECT_EQ(at(12, 12), CellType::kFree);
}

TEST_F(TypedFloor, IsOneWithWhatIsLowerThanAStep) {
  drawn_.hit({{40, 40, 0}, {60, 60, 1}});
  EXPECT_EQ(at(12, 12), CellType::kFree);
}

TEST(TypedGrid, TellsAHoleByRaysThatPassBelowTheFloor) {
  DrawnMap drawn;
  drawn.floor({-10, -10}, {10, 30});
  drawn.floor({14, -10}, {30, 30});
  drawn.pass({{10, -10, -5}, {14, 30, 30}});
  const TypedGrid grid = grid_of(drawn, kTall);
  EXPECT_EQ(grid.at({9, 5}), CellType::kFree);
  for (std::int32_t x = 10; x < 14; ++x) EXPECT_EQ(grid.at({x, 5}), CellType::kNegative) << x;
  EXPECT_EQ(grid.at({20, 5}), CellType::kUnknown) << "beyond the gap";
}

TEST(TypedGrid, DoesNotTakeAHoleThatNobodyLookedIntoToBeFloor) {
  DrawnMap drawn;
  drawn.floor({-10, -10}, {10, 30});
  drawn.floor({14, -10}, {30, 30});
  drawn.pass({{10, -10, 0}, {14, 30, 30}});
  const TypedGrid grid = grid_of(drawn, kTall);
  for (std::int32_t x = 10; x < 14; ++x) EXPECT_EQ(grid.at({x, 5}), CellType::kUnknown) << x;
}

TEST(TypedGrid, BridgesColumnsThatFellBetweenRays) {
  DrawnMap drawn;
  drawn.floor({-10, -10}, {10, 30});
  drawn.floor({12, -10}, {30, 30});
  drawn.pass({{10, -10, 0}, {12, 30, 30}});
  const TypedGrid grid = grid_of(drawn, kTall);
  EXPECT_EQ(grid.at({10, 5}), CellType::kFree);
  EXPECT_EQ(grid.at({20, 5}), CellType::kFree);
}

TEST(TypedGrid, HasAKerbDownAsNegativeAndUpAsAnObstacle) {
  DrawnMap drawn;
  drawn.floor({-10, -10}, {10, 30});
  drawn.floor({10, -10}, {30, 30}, -6);
  const TypedGrid from_above = grid_of(drawn, kTall);
  EXPECT_EQ(from_above.at({8, 5}), CellType::kFree);
  EXPECT_EQ(from_above.at({12, 5}), CellType::kNegative);
  DrawnMap up;
  up.floor({-10, -10}, {10, 30});
  up.floor({10, -10}, {30, 30}, 6);
  const TypedGrid from_below = grid_of(up, kTall);
  EXPECT_EQ(from_below.at({8, 5}), CellType::kFree);
  EXPECT_EQ(from_below.at({12, 5}), CellType::kObstacle);
}

TEST(TypedGrid, DoesNotTakeAKerbWithinAColumnForTwoSmallSteps) {
  DrawnMap drawn;
  drawn.floor({-10, -10}, {10, 30});
  drawn.floor({11, -10}, {30, 30}, 3);
  drawn.hit({{40, -40, -1}, {42, 120, 1}});
  drawn.hit({{42, -40, 2}, {44, 120, 4}});
  drawn.pass({{10, -10, 1}, {11, 30, 30}});
  const TypedGrid grid = grid_of(drawn, kTall);
  EXPECT_EQ(grid.at({8, 5}), CellType::kFree);
  EXPECT_NE(grid.at({10, 5}), CellType::kFree);
  EXPECT_NE(grid.at({15, 5}), CellType::kFree);
}

TEST(TypedGrid, FollowsARampToAnotherHeight) {
  DrawnMap drawn;
  drawn.floor({-10, 0}, {10, 10});
  for (std::int32_t i = 0; i < 40; ++i) drawn.floor({10 + i, 0}, {11 + i, 10}, i / 2);
  drawn.floor({50, 0}, {60, 10}, 20);
  const TypedGrid grid = grid_of(drawn, kTall);
  EXPECT_EQ(grid.at({30, 5}), CellType::kFree);
  EXPECT_EQ(grid.at({55, 5}), CellType::kFree);
}

TEST(TypedGrid, StartsAtTheHeightThatTheRobotDroveAt) {
  DrawnMap drawn;
  drawn.floor({-10, -10}, {30, 30}, 100);
  EXPECT_EQ(grid_of(drawn, kTall, 2.0).at({20, 20}), CellType::kFree);
  EXPECT_NE(grid_of(drawn, kTall, 1.0).at({20, 20}), CellType::kFree);
}

TEST(TypedGrid, HasTheFloorBelowBaseWhereScansAreToldInTheScannersFrame) {
  DrawnMap drawn;
  drawn.floor({-10, -10}, {30, 30}, -40);
  GridBuilder builder({kTall});
  builder.take(drawn.map, drawn.free);
  builder.drive({{0.12, 0.12, 0.0}});
  builder.update();
  EXPECT_EQ(builder.grids().front().at({20, 20}), CellType::kFree);
}

TEST(TypedGrid, IsFreeWhereTheRobotDroveAndNoRayMetTheFloor) {
  DrawnMap drawn;
  drawn.pass({{-8, -8, 0}, {8, 8, 30}});
  const TypedGrid grid = grid_of(drawn, kTall);
  EXPECT_EQ(grid.at({1, 1}), CellType::kFree);
  EXPECT_EQ(grid.at({7, 7}), CellType::kUnknown);
}

TEST(TypedGrid, IsBlockedWhereAPersonSaysSo) {
  DrawnMap drawn;
  drawn.floor({-10, -10}, {30, 30});
  drawn.free.occupied.insert({20, 20, 5});
  EXPECT_EQ(grid_of(drawn, kTall).at({20, 20}), CellType::kOverhang);
  for (std::int32_t z = 0; z < 5; ++z) drawn.free.occupied.insert({20, 20, z});
  EXPECT_EQ(grid_of(drawn, kTall).at({20, 20}), CellType::kObstacle);
}

}  // namespace
}  // namespace voxlist::planning
