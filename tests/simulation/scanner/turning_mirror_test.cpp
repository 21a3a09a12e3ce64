#include "voxlist/simulation/scanner/turning_mirror.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace voxlist::simulation {
namespace {

using Eigen::Vector3d;
using Part = TurningMirror::Part;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kHeight = 0.1;

Vector3d beam(double deg) { return {0.0, std::cos(deg * kRadPerDeg), std::sin(deg * kRadPerDeg)}; }

std::optional<TurningMirror::Contact> meet(const TurningMirrorConfig& config, double beam_deg,
                                           double psi_deg) {
  return TurningMirror(config).meet(Vector3d::Zero(), beam(beam_deg), psi_deg * kRadPerDeg);
}

bool arm_blocks(double beam_deg, double psi_deg) {
  const auto range =
      TurningMirror({}).arm_range_m(Vector3d::Zero(), beam(beam_deg), psi_deg * kRadPerDeg);
  const auto plate = meet({}, beam_deg, psi_deg);
  return range && !(plate && plate->distance_m < *range);
}

TurningMirrorConfig thin() {
  TurningMirrorConfig config;
  config.offset_m = {0.0, 0.0};
  return config;
}

// Reference: where a range r on beam a ends when the mirror's faces run through the axis,
// p = P + Ry(phi) (0, r cos a, r sin a - h), Ry(phi)(x, y, z) = (x cos - z sin, y, x sin + z cos).
Vector3d closed_form(double range_m, double beam_deg, double psi_deg) {
  const double phi = 2.0 * psi_deg * kRadPerDeg;
  const double z = range_m * std::sin(beam_deg * kRadPerDeg) - kHeight;
  return {-z * std::sin(phi), range_m * std::cos(beam_deg * kRadPerDeg),
          kHeight + z * std::cos(phi)};
}

TEST(TurningMirror, ReflectsAsThePaperSaysWhenItsFacesRunThroughTheAxis) {
  for (double psi_deg = 5.0; psi_deg < 360.0; psi_deg += 1.0) {
    if (std::abs(psi_deg - 180.0) < 5.0) continue;
    for (double beam_deg = 25.0; beam_deg <= 155.0; beam_deg += 5.0) {
      const auto contact = meet(thin(), beam_deg, psi_deg);
      ASSERT_TRUE(contact) << beam_deg << " " << psi_deg;
      EXPECT_EQ(contact->part, psi_deg > 180.0 ? Part::kFace0 : Part::kFace1);
      const double range = 4.0;
      const Vector3d point =
          contact->distance_m * beam(beam_deg) + (range - contact->distance_m) * contact->reflected;
      ASSERT_LT((point - closed_form(range, beam_deg, psi_deg)).norm(), 1e-12)
          << beam_deg << " " << psi_deg;
    }
  }
}

TEST(TurningMirror, MovesItsPointsByTwiceItsFacesOffset) {
  TurningMirrorConfig config = thin();
  config.offset_m = {0.003, 0.005};
  for (const double psi_deg : {50.0, 100.0, 140.0, 230.0, 280.0, 320.0}) {
    const int side = psi_deg > 180.0 ? 0 : 1;
    const Vector3d n = (side == 0 ? 1.0 : -1.0) * Vector3d(std::cos(psi_deg * kRadPerDeg), 0.0,
                                                           std::sin(psi_deg * kRadPerDeg));
    for (const double beam_deg : {40.0, 90.0, 120.0}) {
      const auto contact = meet(config, beam_deg, psi_deg);
      const Vector3d point =
          contact->distance_m * beam(beam_deg) + (4.0 - contact->distance_m) * contact->reflected;
      const double e = config.offset_m[static_cast<std::size_t>(side)];
      EXPECT_LT((point - closed_form(4.0, beam_deg, psi_deg) - 2.0 * e * n).norm(), 1e-12);
    }
  }
}

TEST(TurningMirror, TurnsEachSidesBeamByTwiceThatSidesPhase) {
  TurningMirrorConfig config;
  config.phase_deg = {0.25, -0.4};
  EXPECT_LT((meet(config, 90.0, 250.0)->reflected - meet(thin(), 90.0, 250.25)->reflected).norm(),
            1e-12);
  EXPECT_LT((meet(config, 90.0, 70.0)->reflected - meet(thin(), 90.0, 69.6)->reflected).norm(),
            1e-12);
}

TEST(TurningMirror, FlexesWithTheSineOfItsAngle) {
  TurningMirrorConfig config = thin();
  config.flex_deg = 0.3;
  for (const double psi_deg : {30.0, 90.0, 210.0, 270.0}) {
    const double flexed_deg = psi_deg + 0.3 * std::sin(psi_deg * kRadPerDeg);
    EXPECT_LT(
        (meet(config, 80.0, psi_deg)->reflected - meet(thin(), 80.0, flexed_deg)->reflected).norm(),
        1e-12);
  }
}

TEST(TurningMirror, TiltsItsAxisAsTheTwoAnglesSay) {
  // Facing straight down the plate throws the beam back; a roll of the axis tilts its normal by the
  // same angle about x, and the beam by twice that.
  TurningMirrorConfig config = thin();
  config.axis_roll_deg = 0.5;
  const Vector3d rolled = meet(config, 90.0, 90.0)->reflected;
  EXPECT_LT((rolled - Vector3d(0.0, std::sin(kRadPerDeg), -std::cos(kRadPerDeg))).norm(), 1e-12);
  // At 45 deg the beam goes out level across the axis, which a yaw turns with it.
  config = thin();
  config.axis_yaw_deg = 0.5;
  const Vector3d yawed = meet(config, 90.0, 135.0)->reflected;
  const Vector3d normal(std::cos(0.5 * kRadPerDeg), std::sin(0.5 * kRadPerDeg), -1.0);
  const Vector3d expected = Vector3d::UnitZ() - normal * normal.z() * 2.0 / normal.squaredNorm();
  EXPECT_LT((yawed - expected).norm(), 1e-12);
}

TEST(TurningMirror, EndsBeamsAtItsEdgeWhenItIsEdgeOn) {
  for (const double psi_deg : {-1.0, 0.0, 1.0, 179.0, 180.0, 181.0})
    for (const double beam_deg : {40.0, 90.0, 130.0}) {
      const auto contact = meet({}, beam_deg, psi_deg);
      ASSERT_TRUE(contact);
      EXPECT_EQ(contact->part, Part::kEdge);
      EXPECT_NEAR(contact->distance_m * std::sin(beam_deg * kRadPerDeg), 0.05, 0.001);
    }
  EXPECT_NE(meet({}, 90.0, 3.0)->part, Part::kEdge);
}

TEST(TurningMirror, LetsBeamsPassBesideIt) {
  EXPECT_FALSE(meet({}, 15.0, 90.0));
  EXPECT_FALSE(meet({}, 165.0, 90.0));
  EXPECT_TRUE(meet({}, 25.0, 90.0));
  TurningMirrorConfig narrow = thin();
  narrow.half_width_m = 0.02;
  narrow.offset_m = {-0.004, 0.006};  // the plate beside its axis
  EXPECT_FALSE(meet(narrow, 90.0, 0.0));
}

TEST(TurningMirror, ReflectsOnOneSideOnlyWhenTheOtherIsBare) {
  TurningMirrorConfig config;
  config.single_sided = true;
  EXPECT_EQ(meet(config, 90.0, 270.0)->part, Part::kFace0);
  EXPECT_EQ(meet(config, 90.0, 90.0)->part, Part::kEdge);
}

TEST(TurningMirror, HasArmsThatBlockTheirOwnBeamsAtTheirOwnAngles) {
  for (double psi_deg = 0.5; psi_deg < 360.0; psi_deg += 1.0)
    for (double beam_deg = 20.0; beam_deg <= 160.0; beam_deg += 1.0) {
      const bool first = std::abs(psi_deg - 90.0) < 5.7 && beam_deg >= 25.0 && beam_deg <= 60.0;
      const bool second = std::abs(psi_deg - 265.0) < 5.7 && beam_deg >= 120.0 && beam_deg <= 155.0;
      const auto within = [](double value, double of, double what) {
        return std::abs(value - what) < of;
      };
      const bool near_an_end = within(beam_deg, 4.0, 25.0) || within(beam_deg, 4.0, 60.0) ||
                               within(beam_deg, 4.0, 120.0) || within(beam_deg, 4.0, 155.0) ||
                               within(std::abs(psi_deg - 90.0), 1.0, 6.0) ||
                               within(std::abs(psi_deg - 265.0), 1.0, 6.0);
      if (near_an_end) continue;
      ASSERT_EQ(arm_blocks(beam_deg, psi_deg), first || second) << beam_deg << " " << psi_deg;
    }
}

TEST(TurningMirror, BlocksForAboutElevenDegreesNearerThanThePlate) {
  int blocked = 0;
  for (double psi_deg = 80.0; psi_deg < 100.0; psi_deg += 0.1)
    if (arm_blocks(40.0, psi_deg)) ++blocked;
  EXPECT_NEAR(blocked * 0.1, 2.0 * 5.7, 1.0);
  const auto range = TurningMirror({}).arm_range_m(Vector3d::Zero(), beam(40.0), 90.0 * kRadPerDeg);
  EXPECT_NEAR(*range * std::sin(40.0 * kRadPerDeg), 0.034, 1e-9);
}

}  // namespace
}  // namespace voxlist::simulation
