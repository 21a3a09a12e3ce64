#include "voxlist/bus/bus.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <voxlist/map_octree_t.hpp>
#include <voxlist/map_request_t.hpp>
#include <voxlist/pointcloud_t.hpp>
#include <voxlist/pose_t.hpp>

#include "tests/bus/private_network.h"

namespace voxlist::bus {
namespace {

using std::chrono::milliseconds;

BusOptions memory() { return {.url = "memq://", .prefix = ""}; }

pose_t pose_at(std::int64_t utime) {
  pose_t pose{};
  pose.utime = utime;
  return pose;
}

std::int64_t count(const Bus& bus, const std::string& name) {
  const auto found = bus.counters().find(name);
  return found == bus.counters().end() ? 0 : found->second;
}

std::string error_of(const BusOptions& options) {
  try {
    Bus bus(options);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(Bus, HandsOverWhatWasPublishedInOrder) {
  Bus bus(memory());
  std::vector<std::int64_t> seen;
  bus.subscribe(kPose, [&](const pose_t& pose) { seen.push_back(pose.utime); });
  for (std::int64_t utime = 1; utime <= 3; ++utime) bus.publish(kPose, pose_at(utime));
  EXPECT_TRUE(bus.handle(milliseconds(0)));
  EXPECT_EQ(seen, (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_EQ(count(bus, "POSE/sent"), 3);
  EXPECT_EQ(count(bus, "POSE/received"), 3);
  EXPECT_EQ(count(bus, "POSE/handled"), 3);
}

TEST(Bus, HasNothingToDoAndGoesOnWhenNothingCame) {
  Bus bus(memory());
  bus.subscribe(kPose, [](const pose_t&) { FAIL(); });
  EXPECT_TRUE(bus.handle(milliseconds(0)));
}

TEST(Bus, HandsOverOnlyTheNewestWhenAskedAndAfterEverythingElse) {
  Bus bus(memory());
  std::vector<std::int64_t> seen;
  const auto note = [&](const pose_t& pose) { seen.push_back(pose.utime); };
  bus.subscribe(kPose, note, Delivery::kLatest);
  bus.subscribe(kOdometry, note);
  for (std::int64_t utime = 1; utime <= 3; ++utime) bus.publish(kPose, pose_at(utime));
  bus.publish(kOdometry, pose_at(100));
  bus.handle(milliseconds(0));
  EXPECT_EQ(seen, (std::vector<std::int64_t>{100, 3}));
  EXPECT_EQ(count(bus, "POSE/received"), 3);
  EXPECT_EQ(count(bus, "POSE/superseded"), 2);
  EXPECT_EQ(count(bus, "POSE/handled"), 1);
  EXPECT_EQ(bus.losses(), Counters{}) << "nothing is lost that a newer message replaced";
}

TEST(Bus, KeepsTheLastGoodMessageWhenABadOneFollows) {
  Bus bus(memory());
  std::vector<std::int64_t> seen;
  bus.subscribe(
      kPose, [&](const pose_t& pose) { seen.push_back(pose.utime); }, Delivery::kLatest);
  bus.publish(kPose, pose_at(5));
  bus.publish_encoded("POSE", std::vector<std::uint8_t>(20, 0xAA));
  bus.handle(milliseconds(0));
  EXPECT_EQ(seen, (std::vector<std::int64_t>{5}));
  EXPECT_EQ(count(bus, "POSE/wrong_type"), 1);
  EXPECT_EQ(count(bus, "POSE/superseded"), 0);
}

TEST(Bus, CountsWhatItRefusesByReason) {
  Bus bus(memory());
  bus.subscribe(kPose, [](const pose_t&) { FAIL(); });
  std::vector<std::uint8_t> bytes;
  ASSERT_EQ(encode(pose_at(1), bytes), Fault::kNone);
  bus.publish_encoded("POSE", Bytes(bytes).first(50));
  bytes.push_back(0);
  bus.publish_encoded("POSE", bytes);
  bus.publish_encoded("POSE", std::vector<std::uint8_t>(bytes.size(), 1));
  bus.publish_encoded("POSE", {});
  bus.handle(milliseconds(0));
  EXPECT_EQ(count(bus, "POSE/truncated"), 2);
  EXPECT_EQ(count(bus, "POSE/trailing_bytes"), 1);
  EXPECT_EQ(count(bus, "POSE/wrong_type"), 1);
  EXPECT_EQ(count(bus, "POSE/received"), 4);
  EXPECT_EQ(bus.losses(),
            (Counters{{"POSE/trailing_bytes", 1}, {"POSE/truncated", 2}, {"POSE/wrong_type", 1}}));
}

TEST(Bus, CatchesWhatHandlersThrowAndGoesOn) {
  Bus bus(memory());
  int handled = 0;
  bus.subscribe(kPose, [&](const pose_t& pose) {
    if (pose.utime == 1) throw std::runtime_error("first of its kind");
    if (pose.utime == 2) throw 42;
    ++handled;
  });
  for (std::int64_t utime = 1; utime <= 3; ++utime) bus.publish(kPose, pose_at(utime));
  EXPECT_TRUE(bus.handle(milliseconds(0)));
  EXPECT_EQ(handled, 1);
  EXPECT_EQ(count(bus, "POSE/handler_failed"), 2);
  EXPECT_EQ(bus.first_handler_error(), "POSE: first of its kind");
}

TEST(Bus, DoesNotSendMessagesWithWrongLengths) {
  Bus bus(memory());
  bus.subscribe(kCloud, [](const pointcloud_t&) { FAIL(); });
  pointcloud_t cloud{};
  cloud.n_points = 1000;
  bus.publish(kCloud, cloud);
  bus.handle(milliseconds(0));
  EXPECT_EQ(count(bus, "CLOUD/unsent_bad_length"), 1);
  EXPECT_EQ(count(bus, "CLOUD/sent"), 0);
}

TEST(Bus, PutsThePrefixBeforeTheNameOnTheWire) {
  BusOptions options = memory();
  options.prefix = "R2/";
  Bus bus(options);
  int handled = 0;
  bus.subscribe(kPose, [&](const pose_t&) { ++handled; });
  bus.publish(kPose, pose_at(1));
  bus.handle(milliseconds(0));
  EXPECT_EQ(handled, 1);
  EXPECT_EQ(count(bus, "POSE/handled"), 1);
}

TEST(Bus, LetsAHandlerPublishAndSubscribe) {
  Bus bus(memory());
  int answers = 0;
  bus.subscribe(kMapRequest, [&](const map_request_t&) {
    bus.subscribe(kPose, [&](const pose_t&) { ++answers; });
    bus.publish(kPose, pose_at(1));
  });
  bus.publish(kMapRequest, map_request_t{});
  bus.handle(milliseconds(0));
  bus.handle(milliseconds(0));
  EXPECT_EQ(answers, 1);
}

TEST(Bus, SaysWhenTheMessageArrived) {
  Bus bus(memory());
  std::int64_t arrival = 0;
  bus.subscribe(
      kPose, [&](const pose_t&) { arrival = bus.arrival_utime_us(); }, Delivery::kLatest);
  bus.publish(kPose, pose_at(1));
  bus.handle(milliseconds(0));
  EXPECT_GT(arrival, 1'600'000'000'000'000);
}

TEST(Bus, SubscribesAChannelOnce) {
  Bus bus(memory());
  bus.subscribe(kPose, [](const pose_t&) {});
  EXPECT_THROW(bus.subscribe(kPose, [](const pose_t&) {}), std::logic_error);
}

TEST(Bus, EndsACallAfterABoundedNumberOfMessages) {
  Bus bus(memory());
  int handled = 0;
  bus.subscribe(kPose, [&](const pose_t&) {
    ++handled;
    bus.publish(kPose, pose_at(handled));
  });
  bus.publish(kPose, pose_at(0));
  bus.handle(milliseconds(0));
  EXPECT_EQ(handled, 256);
}

TEST(BusOptions, AreRefusedWithALineThatSaysWhatToDo) {
  EXPECT_NE(error_of({.url = "carrier-pigeon://", .prefix = ""}).find("use udpm://"),
            std::string::npos);
  EXPECT_NE(error_of({.url = "memq://", .prefix = "a.*"}).find("prefix 'a.*'"), std::string::npos);
  EXPECT_NE(error_of({.url = "file:///nowhere/log", .prefix = ""}).find("/nowhere/log"),
            std::string::npos);
}

// The tests below run in a private network: the first ones start them there.
TEST(Bus, CarriesLargeCloudsOverUdp) {
  if (!has_private_networks()) GTEST_SKIP() << "no private network namespaces here";
  EXPECT_EQ(run_in_private_network(kWithMulticast, "PrivateNetwork.DISABLED_CarriesLargeClouds"),
            0);
}

TEST(Bus, NamesTheRouteThatIsMissing) {
  if (!has_private_networks()) GTEST_SKIP() << "no private network namespaces here";
  EXPECT_EQ(run_in_private_network("", "PrivateNetwork.DISABLED_NamesTheRoute"), 0);
}

TEST(PrivateNetwork, DISABLED_NamesTheRoute) {
  EXPECT_NE(error_of({}).find("ip route add 224.0.0.0/4 dev lo"), std::string::npos);
}

TEST(PrivateNetwork, DISABLED_CarriesLargeClouds) {
  BusOptions options;
  options.prefix = "ROBOT_1/";
  Bus sender(options);
  Bus receiver(options);
  std::vector<std::size_t> seen;
  receiver.subscribe(kOctomap, [&](const map_octree_t& tree) { seen.push_back(tree.data.size()); });
  map_octree_t tree{};
  tree.num_bytes = 600'000;
  tree.data.resize(600'000);
  for (int i = 0; i < 20; ++i) {
    sender.publish(kOctomap, tree);
    receiver.handle(milliseconds(2000));
  }
  EXPECT_EQ(seen, std::vector<std::size_t>(20, 600'000));
}

TEST(Bus, IsWokenByADeviceThatCanBeRead) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_EQ(write(ends[1], "x", 1), 1);
  Bus bus(memory());
  constexpr std::chrono::hours kLongerThanTheTest(1);
  EXPECT_TRUE(bus.handle(kLongerThanTheTest, ends[0]));
  close(ends[0]);
  close(ends[1]);
}

TEST(BusOptions, AreCheckedWithoutANetwork) {
  for (const std::string url :
       {"udpm://239.255.76.67:7667?ttl=0", "udpm://239.255.76.67:7667?ttl=1&recv_buf_size=8000000",
        "udpm://224.0.0.1", "udpm://", "udpm://?ttl=1", "memq://", "file:///tmp/a b.lcm?speed=0"}) {
    EXPECT_EQ(why_invalid({.url = url, .prefix = "robot_1/"}), "") << url;
  }
  for (const std::string url :
       {"", "udp://239.255.76.67:7667", "udpm://239.255.76.67:0", "udpm://239.255.76.67:70000",
        "udpm://192.168.0.1:7667", "udpm://239.255.76:7667", "udpm://239.255.76.67:7667?ttl"}) {
    EXPECT_NE(why_invalid({.url = url, .prefix = ""}).find("url '" + url + "'"), std::string::npos)
        << url;
  }
  EXPECT_NE(why_invalid({.url = "memq://", .prefix = "a b"}), "");
  EXPECT_NE(why_invalid({.url = "memq://", .prefix = std::string(40, 'a')}), "");
}

}  // namespace
}  // namespace voxlist::bus
