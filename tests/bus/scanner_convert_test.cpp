#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <voxlist/mirror_state_t.hpp>
#include <voxlist/planar_lidar_t.hpp>

#include "voxlist/bus/convert.h"

namespace voxlist::bus {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

LaserLine some_line() { return {77, 0.25, 0.0175, {1.234F, kInfinity, kNan}, {0, 0, 1}}; }

MirrorState some_state() {
  return {5, MirrorState::State::kStalled, true, "the mirror stands", 1.5, -3.0, -7, 0.01, 0.0157};
}

TEST(LaserMessage, KeepsRangesToTheBitAndTheKindsOfNoRangeApart) {
  const auto line = from_message(to_message(some_line()));
  ASSERT_TRUE(line);
  EXPECT_EQ(line->utime_us, 77);
  EXPECT_EQ(line->ranges_m[0], 1.234F);
  EXPECT_EQ(line->ranges_m[1], kInfinity);
  EXPECT_TRUE(std::isnan(line->ranges_m[2]));
  EXPECT_EQ(line->dazzled, some_line().dazzled);
  EXPECT_FLOAT_EQ(static_cast<float>(line->first_angle_rad), 0.25F);
  EXPECT_FLOAT_EQ(static_cast<float>(line->step_rad), 0.0175F);
}

TEST(LaserMessage, TakesAnotherSendersIntensitiesAndNegativeRanges) {
  planar_lidar_t message = to_message(some_line());
  message.ranges[0] = -1.0F;
  message.ranges[1] = -kInfinity;
  message.intensities = {};
  const auto line = from_message(message);
  ASSERT_TRUE(line);
  EXPECT_TRUE(std::isnan(line->ranges_m[0]));
  EXPECT_TRUE(std::isnan(line->ranges_m[1]));
  EXPECT_TRUE(line->dazzled.empty());
}

TEST(LaserMessage, IsRefusedWhenItMakesNoSense) {
  const auto refused = [](auto spoil) {
    planar_lidar_t message = to_message(some_line());
    spoil(message);
    return !from_message(message);
  };
  EXPECT_TRUE(refused([](auto& m) { m.utime = -1; }));
  EXPECT_TRUE(refused([](auto& m) { m.rad0 = kNan; }));
  EXPECT_TRUE(refused([](auto& m) { m.radstep = kNan; }));
  EXPECT_TRUE(refused([](auto& m) { m.radstep = -0.01F; }));
  EXPECT_TRUE(refused([](auto& m) { m.radstep = 10.0F; }));
  EXPECT_TRUE(refused([](auto& m) { m.ranges.clear(); }));
  EXPECT_TRUE(refused([](auto& m) { m.ranges.resize(kMaxBeams + 1); }));
  EXPECT_TRUE(refused([](auto& m) { m.intensities.pop_back(); }));
}

TEST(MirrorMessage, KeepsEveryField) {
  const auto state = from_message(to_message(some_state()));
  ASSERT_TRUE(state);
  EXPECT_EQ(state->utime_us, 5);
  EXPECT_EQ(state->state, MirrorState::State::kStalled);
  EXPECT_TRUE(state->angle_known);
  EXPECT_EQ(state->reason, "the mirror stands");
  EXPECT_EQ(state->angle_rad, 1.5);
  EXPECT_EQ(state->rate_radps, -3.0);
  EXPECT_EQ(state->half_revolutions, -7);
  EXPECT_EQ(state->residual_rad, 0.01);
  EXPECT_EQ(state->step_rad, 0.0157);
}

TEST(MirrorMessage, IsRefusedWhenItMakesNoSense) {
  const auto refused = [](auto spoil) {
    mirror_state_t message = to_message(some_state());
    spoil(message);
    return !from_message(message);
  };
  EXPECT_TRUE(refused([](auto& m) { m.utime = -1; }));
  EXPECT_TRUE(refused([](auto& m) { m.state = 4; }));
  EXPECT_TRUE(refused([](auto& m) { m.state = -1; }));
  EXPECT_TRUE(refused([](auto& m) { m.angle_rad = kNan; }));
  EXPECT_TRUE(refused([](auto& m) { m.angle_rad = -0.1; }));
  EXPECT_TRUE(refused([](auto& m) { m.rate_radps = kInfinity; }));
  EXPECT_TRUE(refused([](auto& m) { m.residual_rad = kNan; }));
  EXPECT_TRUE(refused([](auto& m) { m.step_rad = -1.0; }));
}

}  // namespace
}  // namespace voxlist::bus
