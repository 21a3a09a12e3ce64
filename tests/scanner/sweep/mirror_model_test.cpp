#include "voxlist/scanner/sweep/mirror_model.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/scanner/mirror/physical_mirror.h"

namespace voxlist::scanner {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr std::uint32_t kSeed = 20;

Vector3d beam(double angle_rad) { return {0.0, std::cos(angle_rad), std::sin(angle_rad)}; }

// Random numbers of one test.
struct Dice {
  std::mt19937 engine{kSeed};
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
};

PhysicalMirror::Build random_build(Dice& dice) {
  return {.height_m = dice(0.05, 0.2),
          .offset_m = {dice(-0.004, 0.004), dice(-0.004, 0.004)},
          .phase_rad = {dice(-0.02, 0.02), dice(-0.02, 0.02)},
          .yaw_rad = dice(-0.05, 0.05),
          .roll_rad = dice(-0.05, 0.05)};
}

MirrorModel<> model_of(const PhysicalMirror::Build& build) {
  return {build.phase_rad, build.height_m, build.offset_m, build.yaw_rad, build.roll_rad};
}

// Away from edge-on, where which face the light meets depends on the plate's width.
double random_psi(Dice& dice) {
  return dice(0.0, 1.0) < 0.5 ? dice(0.15, kPi - 0.15) : dice(kPi + 0.15, 2.0 * kPi - 0.15);
}

TEST(MirrorModel, ReflectsAsLightDoesAtAPlateOfAnyBuild) {
  SCOPED_TRACE(kSeed);
  Dice dice;
  constexpr int kRays = 100'000;
  int bounces = 0;
  double worst_m = 0.0, worst_direction = 0.0, worst_path_m = 0.0;
  for (int i = 0; i < kRays; ++i) {
    const PhysicalMirror::Build build = random_build(dice);
    const double psi_rad = random_psi(dice), beam_rad = dice(0.35, kPi - 0.35);
    const auto bounce = PhysicalMirror(build, psi_rad).trace(beam(beam_rad));
    if (!bounce) continue;
    ++bounces;
    const auto ray = model_of(build).reflect(psi_rad, beam_rad);
    ASSERT_EQ(ray.side, bounce->face) << "psi " << psi_rad << " beam " << beam_rad;
    worst_m = std::max(worst_m, (ray.origin_m - bounce->hit).norm());
    worst_direction = std::max(worst_direction, (ray.direction - bounce->direction).norm());
    worst_path_m = std::max(worst_path_m, std::abs(ray.path_m - bounce->hit.norm()));
  }
  EXPECT_EQ(bounces, kRays);
  EXPECT_LT(worst_m, 1e-11);
  EXPECT_LT(worst_direction, 1e-11);
  EXPECT_LT(worst_path_m, 1e-11);
}

TEST(MirrorModel, IsTheClosedFormForAThinMirrorOnALevelAxis) {
  SCOPED_TRACE(kSeed);
  Dice dice;
  const MirrorModel<> model;  // h = 0.1
  for (int i = 0; i < 10'000; ++i) {
    const double psi_rad = random_psi(dice), a = dice(0.35, kPi - 0.35), r = dice(0.5, 8.0);
    const auto ray = model.reflect(psi_rad, a);
    const Vector3d point = ray.origin_m + (r - ray.path_m) * ray.direction;
    // p = P + Ry(phi) (0, r cos a, r sin a - h)
    const double phi = 2.0 * psi_rad, z = r * std::sin(a) - 0.1;
    const Vector3d closed(-z * std::sin(phi), r * std::cos(a), 0.1 + z * std::cos(phi));
    ASSERT_LT((point - closed).norm(), 1e-12);
    ASSERT_NEAR(ray.path_m, 0.1 / std::sin(a), 1e-12);
  }
}

TEST(MirrorModel, ThinMirrorIsHitOnItsAxisWhateverItsAngle) {
  const MirrorModel<> model;
  for (double psi_rad = 0.1; psi_rad < 2.0 * kPi; psi_rad += 0.3)
    for (double a = 0.4; a < kPi - 0.4; a += 0.1) {
      const Vector3d on_axis(0.0, 0.1 / std::tan(a), 0.1);
      ASSERT_LT((model.reflect(psi_rad, a).origin_m - on_axis).norm(), 1e-14);
    }
}

TEST(MirrorModel, HalfATurnLaterThrowsTheBeamToTheSamePlace) {
  MirrorModel<> model;
  model.offset_m = {0.002, 0.002};
  model.axis_yaw_rad = 0.01;
  model.axis_roll_rad = -0.02;
  for (double psi_rad = 0.1; psi_rad < kPi - 0.1; psi_rad += 0.1) {
    const auto one = model.reflect(psi_rad, 1.2), other = model.reflect(psi_rad + kPi, 1.2);
    EXPECT_EQ(one.side, 1);
    EXPECT_EQ(other.side, 0);
    EXPECT_LT((one.origin_m - other.origin_m).norm(), 1e-14);
    EXPECT_LT((one.direction - other.direction).norm(), 1e-14);
  }
}

TEST(MirrorModel, UpwardBeamGoesStraightDownWhenTheMirrorLiesFlat) {
  const auto ray = MirrorModel<>{}.reflect(1.5 * kPi, kPi / 2.0);
  EXPECT_LT((ray.direction - Vector3d(0.0, 0.0, -1.0)).norm(), 1e-14);
  EXPECT_EQ(ray.side, 0);
}

}  // namespace
}  // namespace voxlist::scanner
