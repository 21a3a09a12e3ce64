// The localiser's promise while it tracks: no wrong pose is claimed, odometry carries it where
// walls do not, and a bad scan costs itself. Short drives of all of bench_tracking's kinds; each
// test asks for right answers too: silence is no proof.
#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <string>

#include "tests/bench/drives/claims.h"
#include "tests/bench/test_floor.h"

namespace voxlist::bench {
namespace {

// A seed on which nothing was chosen (see tests/bench/README.md).
constexpr int kSeed = 302;

bool names(const DriveSpec& spec, const char* part) {
  return spec.name.find(part) != std::string::npos;
}

// One drive of each kind that is wanted.
DriveClaims claims_where(const char* what, const std::function<bool(const DriveSpec&)>& wanted) {
  DriveClaims all;
  Reliability reliability;
  std::optional<TestFloor> floor;
  for (const DriveSpec& spec : all_drives()) {
    if (!wanted(spec)) continue;
    if (spec.mapped && !floor) floor = make_test_floor(floor_16_13(kSeed));
    all.add(claims_of(spec, kSeed, 0, spec.mapped ? &floor->map : nullptr, reliability, true));
  }
  std::printf("%s, seed %d: %d scans, %d TRACKING, %d within 0.1 m, %d wrong\n", what, kSeed,
              all.scans, all.tracking, all.near, all.wrong());
  return all;
}

bool in_corridor(const DriveSpec& spec) {
  return spec.place == Place::kBareCorridor || spec.place == Place::kCorridorWithDoors;
}

TEST(NoWrongClaimWhileTracking, AlongCorridorsByOdometry) {
  const DriveClaims claims = claims_where("corridors, odometry", [](const DriveSpec& spec) {
    return in_corridor(spec) && spec.step_m == 0.5 &&
           (spec.wheels == Wheels::kExact || spec.wheels == Wheels::kDrifting);
  });
  EXPECT_EQ(claims.far, 0);
  EXPECT_EQ(claims.beyond_claim, 0);
  EXPECT_GE(claims.tracking, 0.95 * claims.scans);
  // Wheels that drift are 1 % wrong: 0.1 m at the end of a bare corridor.
  EXPECT_GE(claims.near, 0.9 * claims.scans);
}

TEST(NoWrongClaimWhileTracking, AlongABareCorridorWithoutOdometry) {
  const DriveClaims claims = claims_where("bare corridor, no odometry", [](const DriveSpec& spec) {
    return spec.place == Place::kBareCorridor && spec.step_m == 0.5 && spec.wheels == Wheels::kNone;
  });
  EXPECT_EQ(claims.wrong(), 0);
  EXPECT_GE(claims.ambiguous, 0.9 * claims.scans);
}

// Surfaces hold nothing along the corridor, but doors tell by what a step of the wheels was too
// long.
TEST(NoWrongClaimWhileTracking, BetweenDoorsWhereWheelsSlip) {
  const DriveClaims claims = claims_where("doors, slips", [](const DriveSpec& spec) {
    return spec.place == Place::kCorridorWithDoors && spec.wheels == Wheels::kSlipping &&
           spec.laser != Laser::kMirror && spec.step_m == 1.0;
  });
  EXPECT_EQ(claims.wrong(), 0);
  EXPECT_GE(claims.near, 0.7 * claims.scans);
}

// A map of few scan lines has planes that only those lines make, and doors look alike.
TEST(NoWrongClaimWhileTracking, BetweenDoorsWithoutOdometry) {
  const DriveClaims claims = claims_where("doors, no odometry", [](const DriveSpec& spec) {
    return spec.place == Place::kCorridorWithDoors && spec.wheels == Wheels::kNone &&
           spec.laser == Laser::kMirror;
  });
  EXPECT_EQ(claims.wrong(), 0);
  EXPECT_GE(claims.ambiguous, 0.4 * claims.scans);
}

TEST(NoWrongClaimWhileTracking, WithSparseLasersInTheMapThatTheyMake) {
  const DriveClaims claims = claims_where("floors and streets", [](const DriveSpec& spec) {
    return names(spec, "one-scan map, floor") || names(spec, "floor, 16 rings") ||
           spec.name == "street, 16 rings, drifting";
  });
  EXPECT_EQ(claims.wrong(), 0);
  EXPECT_GE(claims.near, 0.9 * claims.scans);
}

TEST(NoWrongClaimWhileTracking, InAFinishedMapAndAfterBeingCarriedAway) {
  const DriveClaims claims = claims_where("mapped", [](const DriveSpec& spec) {
    return spec.mapped && spec.wheels == Wheels::kDrifting;
  });
  EXPECT_EQ(claims.wrong(), 0);
  EXPECT_GT(claims.carried, 0);
  EXPECT_EQ(claims.noticed, claims.carried);
  EXPECT_GE(claims.near, 0.5 * claims.scans);
}

TEST(OneBadScan, CostsItselfWhateverIsWrongWithIt) {
  const DriveClaims claims = claims_where("one bad", [](const DriveSpec& spec) {
    return spec.bad_scans == 1 && spec.wheels == Wheels::kDrifting;
  });
  EXPECT_EQ(claims.far, 0);
  EXPECT_EQ(claims.bad_rows, 20);
  EXPECT_GE(claims.at_next, claims.bad_rows - 1);
}

TEST(FiveBadScans, CostAtMostOneGoodOneByOdometry) {
  const DriveClaims claims = claims_where("five bad", [](const DriveSpec& spec) {
    return spec.bad_scans == 5 && spec.bad != Bad::kOtherPlace &&
           spec.wheels == Wheels::kDrifting && spec.laser == Laser::kMirror;
  });
  EXPECT_EQ(claims.far, 0);
  EXPECT_EQ(claims.bad_rows, 9);
  EXPECT_GE(claims.within_two, claims.bad_rows - 1);
}

}  // namespace
}  // namespace voxlist::bench
