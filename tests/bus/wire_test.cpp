#include "voxlist/bus/wire.h"

#include <gtest/gtest.h>

#include <voxlist/health_t.hpp>
#include <voxlist/map_octree_t.hpp>
#include <voxlist/map_update_t.hpp>
#include <voxlist/pixel_map_t.hpp>
#include <voxlist/planar_lidar_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/rigid_transform_t.hpp>

namespace voxlist::bus {
namespace {

using Buffer = std::vector<std::uint8_t>;

// Places of the lengths in the encoded cloud of make_cloud().
constexpr std::size_t kFrameLengthAt = 8 + 8 + 4;
constexpr std::size_t kFrameTextAt = kFrameLengthAt + 4;
constexpr std::size_t kPointCountAt = kFrameTextAt + 5;
constexpr std::size_t kChannelCountAt = kPointCountAt + 4 + 2 * 12;

pointcloud_t make_cloud() {
  pointcloud_t cloud{};
  cloud.utime = 77;
  cloud.frame_id = "base";
  cloud.n_points = 2;
  cloud.points = {{1, 2, 3}, {4, 5, 6}};
  cloud.n_channels = 1;
  cloud.channel_names = {"intensity"};
  cloud.channels = {{0.5F, 0.25F}};
  return cloud;
}

template <class M>
Buffer encoded(const M& message) {
  Buffer bytes;
  EXPECT_EQ(encode(message, bytes), Fault::kNone);
  return bytes;
}

Buffer with_u32(Buffer bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i)
    bytes.at(at + i) = static_cast<std::uint8_t>(value >> (24 - 8 * i));
  return bytes;
}

TEST(Types, HaveTheFingerprintsThatOtherModulesKnow) {
  EXPECT_EQ(static_cast<std::uint64_t>(planar_lidar_t::getHash()), 0xe3d17423180b5e8dU);
  EXPECT_EQ(static_cast<std::uint64_t>(pose_t::getHash()), 0x2e16efb052b0105eU);
  EXPECT_EQ(static_cast<std::uint64_t>(rigid_transform_t::getHash()), 0xea9ffbf2acc5c5aeU);
  EXPECT_EQ(static_cast<std::uint64_t>(pointcloud_t::getHash()), 0x0d89dc76eb295069U);
  EXPECT_EQ(static_cast<std::uint64_t>(map_octree_t::getHash()), 0xb825cf83ab9af40cU);
  EXPECT_EQ(static_cast<std::uint64_t>(pixel_map_t::getHash()), 0xe4b099a4cce13107U);
}

TEST(Types, StartWithTheirFingerprintOnTheWire) {
  const Buffer bytes = encoded(pose_t{});
  const Buffer expected = {0x2e, 0x16, 0xef, 0xb0, 0x52, 0xb0, 0x10, 0x5e};
  EXPECT_EQ(Buffer(bytes.begin(), bytes.begin() + 8), expected);
}

TEST(Wire, DecodesWhatWasEncoded) {
  pointcloud_t cloud{};
  ASSERT_EQ(decode(encoded(make_cloud()), cloud), Fault::kNone);
  EXPECT_EQ(cloud.utime, 77);
  EXPECT_EQ(cloud.frame_id, "base");
  EXPECT_EQ(cloud.points, make_cloud().points);
  EXPECT_EQ(cloud.channels, make_cloud().channels);
}

TEST(Wire, RefusesEveryTruncationOfAMessage) {
  const Buffer bytes = encoded(make_cloud());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_EQ(check_wire<pointcloud_t>(Bytes(bytes).first(size)), Fault::kTruncated) << size;
  }
}

TEST(Wire, RefusesAnotherTypesMessage) {
  EXPECT_EQ(check_wire<pose_t>(encoded(make_cloud())), Fault::kWrongType);
}

TEST(Wire, RefusesBytesLeftOver) {
  Buffer bytes = encoded(make_cloud());
  bytes.push_back(0);
  EXPECT_EQ(check_wire<pointcloud_t>(bytes), Fault::kTrailingBytes);
}

TEST(Wire, RefusesNegativeLengths) {
  const Buffer bytes = encoded(make_cloud());
  for (const std::size_t at : {kFrameLengthAt, kPointCountAt, kChannelCountAt}) {
    EXPECT_EQ(check_wire<pointcloud_t>(with_u32(bytes, at, 0xFFFFFFFF)), Fault::kBadLength) << at;
  }
}

TEST(Wire, RefusesLengthsThatReachPastTheEnd) {
  const Buffer bytes = encoded(make_cloud());
  for (const std::uint32_t length : {3U, 100'000'000U, 0x15555556U, 0x20000000U, 0x40000000U}) {
    EXPECT_NE(check_wire<pointcloud_t>(with_u32(bytes, kPointCountAt, length)), Fault::kNone)
        << length;
  }
  EXPECT_EQ(check_wire<pointcloud_t>(with_u32(bytes, kPointCountAt, 1'000)), Fault::kTruncated);
}

TEST(Wire, RefusesMoreChannelsThanACloudCanSensiblyHave) {
  EXPECT_EQ(check_wire<pointcloud_t>(with_u32(encoded(make_cloud()), kChannelCountAt, 65)),
            Fault::kTooLarge);
}

TEST(Wire, RefusesTextThatDoesNotEndWhereItSays) {
  Buffer open_end = encoded(make_cloud());
  open_end[kFrameTextAt + 4] = 'x';
  EXPECT_EQ(check_wire<pointcloud_t>(open_end), Fault::kBadText);
  Buffer early_end = encoded(make_cloud());
  early_end[kFrameTextAt + 1] = 0;
  EXPECT_EQ(check_wire<pointcloud_t>(early_end), Fault::kBadText);
  EXPECT_EQ(check_wire<pointcloud_t>(with_u32(encoded(make_cloud()), kFrameLengthAt, 0)),
            Fault::kBadLength);
}

TEST(Wire, RefusesMessagesAboveTheLimitBeforeLookingInside) {
  const Buffer bytes(kMaxMessageBytes + 1);
  EXPECT_EQ(check_wire<pointcloud_t>(bytes), Fault::kTooLarge);
}

TEST(Wire, WillNotEncodeCountsThatAreNotTheArraysLengths) {
  Buffer bytes;
  pointcloud_t cloud = make_cloud();
  cloud.n_points = 3;
  EXPECT_EQ(encode(cloud, bytes), Fault::kBadLength);
  cloud = make_cloud();
  cloud.points[1].pop_back();
  EXPECT_EQ(encode(cloud, bytes), Fault::kBadLength);
  cloud = make_cloud();
  cloud.channels[0].pop_back();
  EXPECT_EQ(encode(cloud, bytes), Fault::kBadLength);
  cloud = make_cloud();
  cloud.n_channels = 0;
  EXPECT_EQ(encode(cloud, bytes), Fault::kBadLength);
}

TEST(Wire, WillNotEncodeAMapUpdateWhoseCountsAreNotItsListsLengths) {
  Buffer bytes;
  map_update_t update{};
  update.blocks.resize(2);
  update.n_blocks = 2;
  update.passed_blocks.resize(3);
  update.n_passed_blocks = 3;
  EXPECT_EQ(encode(update, bytes), Fault::kNone);
  update.n_passed_blocks = 2;
  EXPECT_EQ(encode(update, bytes), Fault::kBadLength);
  update.n_passed_blocks = 3;
  update.n_blocks = 3;
  EXPECT_EQ(encode(update, bytes), Fault::kBadLength);
}

TEST(Wire, RefusesForgedLengthsOfEitherListOfAMapUpdate) {
  map_update_t update{};
  update.blocks.resize(2);
  update.n_blocks = 2;
  update.passed_blocks.resize(3);
  update.n_passed_blocks = 3;
  const Buffer bytes = encoded(update);
  constexpr std::size_t kBlockBytes = 76, kAfterThem = 40;
  const std::size_t passed_count_at = bytes.size() - kAfterThem - 3 * kBlockBytes - 4;
  for (const std::size_t at : {passed_count_at - 2 * kBlockBytes - 4, passed_count_at}) {
    EXPECT_EQ(check_wire<map_update_t>(with_u32(bytes, at, 0xFFFFFFFF)), Fault::kBadLength);
    EXPECT_EQ(check_wire<map_update_t>(with_u32(bytes, at, 0x20000000)), Fault::kTooLarge);
    EXPECT_EQ(check_wire<map_update_t>(with_u32(bytes, at, 100)), Fault::kTruncated);
  }
  EXPECT_EQ(check_wire<map_update_t>(with_u32(bytes, passed_count_at, 2)), Fault::kTrailingBytes);
}

TEST(Wire, WillNotEncodeTextWithAZeroInside) {
  Buffer bytes;
  health_t health{};
  health.n_counters = 1;
  health.counters = {{std::string("a\0b", 3), 1}};
  EXPECT_EQ(encode(health, bytes), Fault::kBadText);
}

TEST(Wire, WillNotEncodeWhatItWouldRefuseToReceive) {
  Buffer bytes;
  map_octree_t tree{};
  tree.data.resize(kMaxMessageBytes);
  tree.num_bytes = kMaxMessageBytes;
  EXPECT_EQ(encode(tree, bytes), Fault::kTooLarge);
}

TEST(Wire, NamesEveryFaultOnce) {
  std::vector<std::string> names;
  for (int fault = 0; fault <= static_cast<int>(Fault::kCodecFailed); ++fault) {
    names.emplace_back(fault_name(static_cast<Fault>(fault)));
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace voxlist::bus
