#include "voxlist/matching/floors/levelling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/angle.h"

namespace voxlist::matching {
namespace {

constexpr double kUp_rad = -8.0 * kRadPerDeg;  // the nose is up
const Pose2 kAhead{1.0, 0.0, 0.0};

// A robot that was last at the origin, driving up a ramp.
Levelling on_a_ramp() {
  Levelling levelling;
  levelling.learn({}, {0.0, 0.0, kUp_rad}, std::nullopt);
  return levelling;
}

TEST(Levelling, ARobotClimbsAsItLeans) {
  const std::vector<Tilt> guesses = on_a_ramp().guesses({}, kAhead);
  ASSERT_FALSE(guesses.empty());
  EXPECT_NEAR(guesses.front().z_m, std::sin(-kUp_rad), 1e-9);
  EXPECT_NEAR(on_a_ramp().guesses({}, {-1.0, 0.0, 0.0}).front().z_m, std::sin(kUp_rad), 1e-9);
  EXPECT_NEAR(on_a_ramp().guesses({}, {0.0, 1.0, 0.0}).front().z_m, 0.0, 1e-9);
}

TEST(Levelling, ARobotDoesNotJump) {
  const Levelling levelling = on_a_ramp();
  EXPECT_TRUE(levelling.reaches(kAhead, {0.14, 0.0, kUp_rad}));
  EXPECT_TRUE(levelling.reaches(kAhead, {0.07, 0.0, 0.0}));
  EXPECT_FALSE(levelling.reaches(kAhead, {0.5, 0.0, kUp_rad}));
  EXPECT_FALSE(levelling.reaches(kAhead, {-0.3, 0.0, 0.0}));
  EXPECT_TRUE(Levelling().reaches(kAhead, {3.0, 0.0, 0.0}));
}

TEST(Levelling, WhereNoFloorIsToldARampMayEnd) {
  const auto lists = [](const std::vector<Tilt>& guesses, double pitch_deg) {
    return std::any_of(guesses.begin(), guesses.end(), [&](const Tilt& guess) {
      return std::abs(guess.pitch_rad - pitch_deg * kRadPerDeg) < 1e-9;
    });
  };
  EXPECT_TRUE(lists(on_a_ramp().guesses({}, kAhead), -4.0));
  KnownTilt known;
  known.floor = Floor{{0.0, 0.0, kUp_rad}, 0.0, 1.0};
  EXPECT_FALSE(lists(on_a_ramp().guesses(known, kAhead), -4.0));
}

TEST(Levelling, AMapThatIsAnotherTurnsTheWay) {
  Levelling levelling = on_a_ramp();
  levelling.change_map({10.0, 0.0, 90.0 * kRadPerDeg});
  EXPECT_NEAR(levelling.guesses({}, {10.0, 1.0, 90.0 * kRadPerDeg}).front().z_m, std::sin(-kUp_rad),
              1e-9);
}

}  // namespace
}  // namespace voxlist::matching
