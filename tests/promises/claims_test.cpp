// The first promise of the localiser: it never claims a pose that is wrong. One building of each
// kind, a few scans and one drive in it. Each test asks for right answers too: silence is no proof.
#include <gtest/gtest.h>

#include "tests/bench/answers.h"
#include "tests/bench/test_drive.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::bench {
namespace {

// Seeds of buildings on which nothing was chosen (see tests/bench/README.md).
constexpr int kOrdinarySeed = 161, kHotelSeed = 162, kIdenticalSeed = 163, kFewScansSeed = 164;
constexpr int kScans = 8;

TestFloorConfig one_wing(TestFloorConfig config, double length_m, int rooms) {
  config.wings = 1;
  config.wing.length_m = length_m;
  config.wing.rooms = rooms;
  return config;
}

TestFloorConfig ordinary_floor() { return one_wing(floor_60_40(kOrdinarySeed), 60.0, 20); }
TestFloorConfig hotel() { return one_wing(hotel_floor(kHotelSeed), 20.0, 8); }
TestFloorConfig identical_rooms() { return one_wing(identical_floor(kIdenticalSeed), 20.0, 8); }

// What was claimed of scans by themselves, and of the scans of a drive.
struct Claims {
  Tally scans, drive;
  bool tracking_in_the_end = false;

  int wrong() const { return scans.tracking_wrong + drive.tracking_wrong; }
};

// The right place is claimed, or is among those that are listed.
int right_or_listed(const Tally& tally) { return tally.tracking_right + tally.ambiguous_listed; }

// A robot that has the map of a floor.
class Robot {
 public:
  Robot(const TestFloorConfig& config, int seed)
      : seed_(seed), floor_(make_test_floor(config)), localiser_(floor_.map) {
    std::printf("%s: seed %d\n", floor_.name.c_str(), seed_);
  }

  // What it claims as it stands here and there, and on one drive from a room into the corridor.
  Claims claims(const Kind& kind) {
    const simulation::Building building = now(kind, floor_.config);
    Claims claims;
    for (const auto& [scan, truth] : scans_about(kind, floor_, building, kScans, seed_))
      claims.scans.add(localiser_.locate(scan), truth, kind.foreign);
    localiser_.forget();
    simulation::Random random(4713, static_cast<std::uint64_t>(seed_));
    for (const auto& [scan, truth, T_odom_base] : drive_through(
             floor_, building, DriveKind::kDoor, kind.people, static_cast<std::uint64_t>(seed_))) {
      const matching::Localisation result =
          localiser_.localise(as_seen(kind, scan, random), T_odom_base);
      claims.drive.add(result, truth, kind.foreign);
      claims.tracking_in_the_end = result.tracking();
    }
    claims.scans.print(kind.name);
    claims.drive.print(kind.name + ", driving");
    return claims;
  }

 private:
  const int seed_;
  const TestFloor floor_;
  matching::Localiser localiser_;
};

TEST(NoWrongClaim, WhereAllIsAsItWasMapped) {
  const Claims claims = Robot(ordinary_floor(), kOrdinarySeed).claims({.name = "ordinary"});
  EXPECT_EQ(claims.wrong(), 0);
  EXPECT_GE(claims.scans.tracking_right, kScans - 2);
  EXPECT_GE(claims.drive.tracking_right, claims.drive.asked - 1);
}

TEST(NoWrongClaim, WhereFurnitureWasMovedAndPeopleStandAbout) {
  const Claims claims = Robot(ordinary_floor(), kOrdinarySeed)
                            .claims({.name = "changed", .changed = true, .people = 3});
  EXPECT_EQ(claims.wrong(), 0);
  EXPECT_GE(right_or_listed(claims.scans), kScans - 2);
  EXPECT_TRUE(claims.tracking_in_the_end);
}

// No place explains a return from the middle of a ray: it says nothing against the right one.
TEST(NoWrongClaim, WhereOneReturnInTwentyIsShortBesides) {
  const Claims claims =
      Robot(ordinary_floor(), kOrdinarySeed)
          .claims({.name = "changed short", .changed = true, .people = 3, .short_returns = 0.05});
  EXPECT_EQ(claims.wrong(), 0);
  EXPECT_GE(right_or_listed(claims.scans), kScans - 2);
  EXPECT_TRUE(claims.tracking_in_the_end);
}

TEST(NoWrongClaim, InABuildingThatTheMapIsNotOf) {
  Robot robot(ordinary_floor(), kOrdinarySeed);
  EXPECT_GT(robot.claims({.name = "ordinary"}).scans.tracking_right, 0);
  const Claims claims = robot.claims({.name = "foreign", .foreign = true});
  EXPECT_EQ(claims.wrong(), 0);
  EXPECT_EQ(claims.scans.ambiguous + claims.scans.lost, kScans);
  EXPECT_EQ(claims.drive.ambiguous + claims.drive.lost, claims.drive.asked);
}

TEST(NoWrongClaim, InAHotelWhoseRoomsDifferBySmallObjects) {
  const Claims claims = Robot(hotel(), kHotelSeed).claims({.name = "hotel"});
  EXPECT_EQ(claims.wrong(), 0);
  EXPECT_EQ(right_or_listed(claims.scans), kScans);
  EXPECT_EQ(right_or_listed(claims.drive), claims.drive.asked);
}

TEST(NoWrongClaim, WhereNothingTellsOneRoomFromAnother) {
  const Claims claims = Robot(identical_rooms(), kIdenticalSeed).claims({.name = "identical"});
  EXPECT_EQ(claims.wrong(), 0);
  EXPECT_EQ(claims.scans.ambiguous_listed, kScans);
  EXPECT_EQ(claims.drive.ambiguous_listed, claims.drive.asked);
}

TEST(NoWrongClaim, InAMapOfFewScans) {
  const Claims claims =
      Robot(few_scans_floor(kFewScansSeed), kFewScansSeed).claims({.name = "few map scans"});
  EXPECT_EQ(claims.wrong(), 0);
  EXPECT_GE(claims.scans.tracking_right, kScans / 2);
  EXPECT_GE(right_or_listed(claims.scans), kScans - 2);
  EXPECT_TRUE(claims.tracking_in_the_end);
}

}  // namespace
}  // namespace voxlist::bench
