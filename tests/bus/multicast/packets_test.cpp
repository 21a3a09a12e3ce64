#include "voxlist/bus/multicast/packets.h"

#include <gtest/gtest.h>

namespace voxlist::bus {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(Packets, AMessageThatFitsIsOneWithItsChannel) {
  const Bytes message = {7, 8};
  const std::vector<Packet> packets = packets_of("AB", message, 0x01020304);
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_EQ(packets[0].head, (Bytes{'L', 'C', '0', '2', 1, 2, 3, 4, 'A', 'B', 0}));
  EXPECT_EQ(packets[0].body.data(), message.data());
  EXPECT_EQ(packets[0].size(), 13U);
}

TEST(Packets, ALargerMessageIsFragmentsThatCarryAllOfIt) {
  const Bytes message(200'000, 1);
  const std::vector<Packet> packets = packets_of("AB", message, 5);
  ASSERT_EQ(packets.size(), 4U);
  // 200,000 B, from 65,484 on, fragment 1 of 4.
  EXPECT_EQ(packets[1].head, (Bytes{'L',  'C',  '0', '3', 0,    0,    0, 5, 0, 3,
                                    0x0d, 0x40, 0,   0,   0xff, 0xcc, 0, 1, 0, 4}));
  std::size_t carried = 0;
  for (const Packet& packet : packets) {
    EXPECT_EQ(packet.body.data(), message.data() + carried);
    EXPECT_LE(packet.size(), 65'507U);
    carried += packet.body.size();
  }
  EXPECT_EQ(carried, message.size());
}

}  // namespace
}  // namespace voxlist::bus
