#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/simulation/floor.h"
#include "voxlist/simulation/random.h"

namespace voxlist::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

BuildingConfig alike(int objects, int seed = 1) {
  BuildingConfig config;
  config.length_m = 30.0;
  config.rooms = 12;
  config.alike = 5;
  config.objects = objects;
  config.seed = seed;
  return config;
}

// +1 left of the corridor, -1 right of it, where rooms are turned round. For the first wing.
double side(const Room& room) { return room.door.y() > room.centre().y() ? -1.0 : 1.0; }

// Distances from the room's middle along rays that do not leave by its door, in the room's axes.
std::vector<double> seen_from_the_middle(const Building& building, const Room& room) {
  Random random(11);
  std::vector<double> ranges;
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(0, 1), z = random.uniform(-1, 1);
    const Vector2d along = side(room) * Vector2d(x, y);
    const Vector3d eye(room.centre().x(), room.centre().y(), 1.0);
    ranges.push_back(
        building.solid.range(eye, Vector3d(along.x(), along.y(), z).normalized()).value());
  }
  return ranges;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

// What stands in a room, as places in the room's own axes from its own corner.
std::vector<Vector2d> places_in(const Building& building, const Room& room) {
  std::vector<Vector2d> places;
  for (const Box& box : building.solid.boxes()) {
    const Vector2d at = box.centre_m.head<2>();
    if ((at.array() > room.low.array()).all() && (at.array() < room.high.array()).all())
      places.push_back(side(room) > 0.0 ? Vector2d(at - room.low) : Vector2d(room.high - at));
  }
  return places;
}

TEST(AlikeRooms, LookTheSameFromTheInsideOnBothSidesOfTheCorridor) {
  const Building building = make_building(alike(0));
  ASSERT_EQ(building.rooms.size(), 12u);
  const auto first = seen_from_the_middle(building, building.rooms.front());
  EXPECT_GT(places_in(building, building.rooms.front()).size(), 5u);
  for (const Room& room : building.rooms) {
    EXPECT_LT(largest_difference(first, seen_from_the_middle(building, room)), 1e-9);
    const double into = side(room) * (room.door.x() - room.centre().x());
    EXPECT_NEAR(into, building.rooms.front().door.x() - building.rooms.front().centre().x(), 1e-9);
  }
}

TEST(AlikeRooms, LieOnAFloorThatIsTheSameTurnedRound) {
  const Building building = make_building(alike(0));
  const Vector2d middle(14.0, 0.0);
  Random random(12);
  for (int i = 0; i < 2000; ++i) {
    const Vector2d at(random.uniform(-0.9, 28.9), random.uniform(-5.9, 5.9));
    EXPECT_NEAR(building.clearance_m(at, 0.02, 2.0),
                building.clearance_m(2.0 * middle - at, 0.02, 2.0), 1e-9);
  }
}

std::size_t common(const std::vector<Vector2d>& a, const std::vector<Vector2d>& b) {
  return static_cast<std::size_t>(std::count_if(a.begin(), a.end(), [&b](const Vector2d& at) {
    return std::any_of(b.begin(), b.end(),
                       [&at](const Vector2d& other) { return (at - other).norm() < 1e-9; });
  }));
}

TEST(AlikeRooms, DifferByTwoSmallObjectsEach) {
  const Building bare = make_building(alike(0)), building = make_building(alike(2));
  const std::size_t furniture = places_in(bare, bare.rooms.front()).size();
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    const auto here = places_in(building, building.rooms[i]);
    EXPECT_EQ(here.size(), furniture + 2) << i;
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_EQ(common(here, places_in(building, building.rooms[k])), furniture) << i << ' ' << k;
  }
}

TEST(AlikeRooms, LeaveTheWayThroughTheDoorFree) {
  for (int seed = 1; seed <= 10; ++seed) {
    const Building building = make_building(alike(2, seed));
    for (const Room& room : building.rooms) {
      const Vector2d in = room.door + Vector2d(0.0, 0.5 * side(room));
      for (double share = 0.0; share <= 1.0; share += 0.05) {
        const Vector2d to_door(room.door.x(), share * room.door.y());
        EXPECT_GE(building.clearance_m(to_door, 0.02, 1.0), 0.45) << "seed " << seed;
        EXPECT_GE(building.clearance_m(in + share * (room.centre() - in), 0.02, 1.0), 0.45)
            << "seed " << seed;
      }
    }
  }
}

std::vector<double> numbers(const BuildingConfig& config) {
  std::vector<double> numbers;
  const Building building = make_building(config);
  for (const Box& box : building.solid.boxes())
    numbers.push_back(box.centre_m.x() + 100.0 * box.centre_m.y() + 1e6 * box.half_m.prod());
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

TEST(AlikeRooms, AreTheSameForASeedAndDifferInTheObjectsAloneForAnother) {
  const auto first = numbers(alike(2)), again = numbers(alike(2)), other = numbers(alike(2, 2));
  EXPECT_EQ(first, again);
  EXPECT_NE(first, other);
  EXPECT_EQ(numbers(alike(0)), numbers(alike(0, 2)));
  std::vector<double> both;
  std::set_intersection(first.begin(), first.end(), other.begin(), other.end(),
                        std::back_inserter(both));
  EXPECT_EQ(both.size(), first.size() - 24);
}

TEST(AlikeRooms, AreSoInAllWingsOfAFloor) {
  const Building building = make_floor(alike(1), 2);
  ASSERT_EQ(building.rooms.size(), 24u);
  const auto here = places_in(building, building.rooms[0]);
  const auto there = places_in(building, building.rooms[12]);
  ASSERT_EQ(here.size(), there.size());
  EXPECT_EQ(common(here, there), here.size() - 1);  // all but the object
}

TEST(AlikeRooms, ComeInPairsAndWithoutStairs) {
  BuildingConfig config = alike(0);
  config.rooms = 11;
  EXPECT_THROW(make_building(config), std::invalid_argument);
  config = alike(0);
  config.stairs = 1;
  EXPECT_THROW(make_building(config), std::invalid_argument);
}

TEST(Objects, StandInRoomsThatAreNotAlikeToo) {
  BuildingConfig config;
  const std::size_t without = make_building(config).solid.boxes().size();
  config.objects = 3;
  EXPECT_EQ(make_building(config).solid.boxes().size(), without + 18);
}

}  // namespace
}  // namespace voxlist::simulation
