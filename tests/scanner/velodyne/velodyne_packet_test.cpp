#include "voxlist/scanner/velodyne/velodyne_packet.h"

#include <gtest/gtest.h>

#include "tests/scanner/velodyne/velodyne_encoder.h"
#include "voxlist/geometry/angle.h"

namespace voxlist::scanner {
namespace {

using test::VelodyneEncoder;

// One return alone in a packet; nothing when there is not just one.
std::vector<VelodyneReturn> all_of(const VelodynePacket& packet) {
  std::vector<VelodyneReturn> all;
  for (const VelodyneBlock& block : packet.blocks)
    all.insert(all.end(), block.returns.begin(), block.returns.end());
  return all;
}

VelodyneEncoder::Returns only(int block, int i, int range = 5'000, int intensity = 77) {
  return [=](int b, int at) {
    return b == block && at == i ? std::pair{range, intensity} : std::pair{0, 0};
  };
}

TEST(VelodynePacket, ReadsAReturnOfAVlp16) {
  VelodyneEncoder laser;
  laser.azimuth_cdeg = 9'000 - 3 * 40;
  laser.stamp_us = 123'456'789;
  // Laser 1 in the second firing of the fourth block.
  const VelodynePacket packet = read_velodyne(laser.packet(only(3, 17)));
  ASSERT_EQ(packet.kind, VelodyneKind::kData);
  EXPECT_EQ(packet.stamp_us, 123'456'789U);
  EXPECT_NEAR(packet.length_us, 1327.104, 1e-6);
  const auto returns = all_of(packet);
  ASSERT_EQ(returns.size(), 1u);
  EXPECT_EQ(returns[0].ring, 8) << "of 16, the first above the horizon";
  EXPECT_EQ(returns[0].intensity, 77);
  const double in_block_us = 55.296 + 2.304;
  EXPECT_NEAR(returns[0].after_us, 3 * 110.592 + in_block_us, 1e-6);
  const double azimuth_rad = (90.0 + 0.4 * in_block_us / 110.592) * kRadPerDeg;
  const double flat_m = 10.0 * std::cos(kRadPerDeg);
  EXPECT_NEAR(returns[0].point.x(), flat_m * std::cos(azimuth_rad), 1e-5);
  EXPECT_NEAR(returns[0].point.y(), -flat_m * std::sin(azimuth_rad), 1e-5) << "clockwise";
  EXPECT_NEAR(returns[0].point.z(), 10.0 * std::sin(kRadPerDeg) - 0.0007, 1e-5);
}

TEST(VelodynePacket, ReadsAReturnOfAnHdl32e) {
  VelodyneEncoder laser;
  laser.model = 0x21;
  laser.turn_cdeg = 17;
  const VelodynePacket packet = read_velodyne(laser.packet(only(11, 31)));
  EXPECT_NEAR(packet.length_us, 552.96, 1e-6);
  const auto returns = all_of(packet);
  ASSERT_EQ(returns.size(), 1u);
  EXPECT_EQ(returns[0].ring, 31);
  EXPECT_NEAR(returns[0].after_us, 11 * 46.08 + 31 * 1.152, 1e-6);
  EXPECT_NEAR(returns[0].point.z(), 10.0 * std::sin(10.67 * kRadPerDeg), 1e-5);
}

TEST(VelodynePacket, RingsAreInTheOrderOfTheirElevations) {
  for (const std::uint8_t model : {std::uint8_t{0x21}, std::uint8_t{0x22}}) {
    VelodyneEncoder laser;
    laser.model = model;
    const auto returns = all_of(read_velodyne(laser.packet([](int block, int) {
      return std::pair{block == 0 ? 5'000 : 0, 1};
    })));
    ASSERT_EQ(returns.size(), 32u);
    for (const VelodyneReturn& a : returns)
      for (const VelodyneReturn& b : returns)
        EXPECT_EQ(a.ring < b.ring, a.point.z() < b.point.z() - 0.05F);
  }
}

TEST(VelodynePacket, TakesBothReturnsOfARayOnceWhereTheyAreTheSame) {
  VelodyneEncoder laser;
  laser.mode = 0x39;
  const VelodynePacket packet = read_velodyne(laser.packet([](int block, int i) {
    if (i > 1) return std::pair{0, 0};
    return std::pair{i == 0 ? 5'000 : 5'000 + block, 1};
  }));
  EXPECT_NEAR(packet.length_us, 663.552, 1e-6);
  const auto returns = all_of(packet);
  ASSERT_EQ(returns.size(), 18u) << "of each of six pairs: one, and two that differ";
  EXPECT_EQ(returns[0].after_us, 0.0);
  EXPECT_EQ(returns[2].after_us, returns[1].after_us);
  EXPECT_NEAR(returns[3].after_us, 110.592, 1e-6);
}

TEST(VelodynePacket, FollowsTheAzimuthOverTheTurn) {
  VelodyneEncoder laser;
  laser.azimuth_cdeg = 35'990;
  const auto returns = all_of(read_velodyne(laser.packet(only(0, 16))));
  ASSERT_EQ(returns.size(), 1u);
  EXPECT_LT(returns[0].point.y(), 0.0F) << "0.1 deg past 0, clockwise";
}

TEST(VelodynePacket, NamesWhatIsNone) {
  VelodyneEncoder laser;
  std::vector<std::uint8_t> bytes = laser.packet(only(0, 0));
  EXPECT_EQ(read_velodyne(std::span(bytes).first(512)).kind, VelodyneKind::kNoData);
  EXPECT_EQ(read_velodyne({}).kind, VelodyneKind::kNoData);
  std::vector<std::uint8_t> torn = bytes;
  torn[500] = 0;
  EXPECT_EQ(read_velodyne(torn).kind, VelodyneKind::kBroken);
  torn = bytes;
  torn[3] = 0xFF;
  EXPECT_EQ(read_velodyne(torn).kind, VelodyneKind::kBroken) << "an azimuth beyond 360 deg";
  torn = bytes;
  torn[1205] = 0x28;
  EXPECT_EQ(read_velodyne(torn).kind, VelodyneKind::kUnknownModel);
  EXPECT_EQ(read_velodyne(torn).model, 0x28);
}

}  // namespace
}  // namespace voxlist::scanner
