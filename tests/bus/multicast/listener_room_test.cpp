#include "voxlist/bus/multicast/listener_room.h"

#include <gtest/gtest.h>

namespace voxlist::bus {
namespace {

constexpr std::int64_t kFull = ListenerRoom::kMaxWaiting + 1;

UdpSocket listener(std::uint64_t inode, std::int64_t waiting_bytes) {
  return {.port = 7667, .waiting_bytes = waiting_bytes, .inode = inode, .dropped_packets = 0};
}

TEST(ListenerRoom, IsThereWhenAllHaveRead) {
  ListenerRoom room;
  EXPECT_TRUE(room.is_there({}, 0)) << "nobody listens";
  EXPECT_TRUE(room.is_there({listener(1, 0), listener(2, ListenerRoom::kMaxWaiting)}, 0));
  EXPECT_FALSE(room.is_there({listener(1, 0), listener(2, kFull)}, 0));
}

TEST(ListenerRoom, NobodyWaitsForAListenerThatIsStopped) {
  ListenerRoom room;
  const std::vector<UdpSocket> stopped = {listener(1, kFull)};
  EXPECT_FALSE(room.is_there(stopped, 1000));
  EXPECT_FALSE(room.is_there(stopped, 1000 + ListenerRoom::kPatience_us - 1));
  EXPECT_TRUE(room.is_there(stopped, 1000 + ListenerRoom::kPatience_us));
  EXPECT_FALSE(room.is_there({listener(1, kFull), listener(2, kFull)}, 1'000'000))
      << "another one is waited for";
}

TEST(ListenerRoom, AListenerThatReadAgainIsWaitedForAgain) {
  ListenerRoom room;
  const std::vector<UdpSocket> full = {listener(1, kFull)};
  room.is_there(full, 0);
  EXPECT_TRUE(room.is_there(full, ListenerRoom::kPatience_us));
  EXPECT_TRUE(room.is_there({listener(1, 0)}, ListenerRoom::kPatience_us + 1));
  EXPECT_FALSE(room.is_there(full, ListenerRoom::kPatience_us + 2));
}

}  // namespace
}  // namespace voxlist::bus
