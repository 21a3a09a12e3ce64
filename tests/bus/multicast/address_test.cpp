#include "voxlist/bus/multicast/address.h"

#include <gtest/gtest.h>

namespace voxlist::bus {
namespace {

TEST(MulticastAddress, IsReadFromAUrl) {
  const auto address = multicast_address("udpm://224.1.2.3:7000?recv_buf_size=100&ttl=1");
  ASSERT_TRUE(address);
  EXPECT_EQ(address->group, "224.1.2.3");
  EXPECT_EQ(address->port, 7000);
  EXPECT_EQ(address->ttl, 1);
}

TEST(MulticastAddress, IsLcmsOwnWhereTheUrlLeavesItOut) {
  for (const char* url : {"udpm://", "udpm://?recv_buf_size=5", "udpm://239.255.76.67"}) {
    const auto address = multicast_address(url);
    ASSERT_TRUE(address) << url;
    EXPECT_EQ(address->group, "239.255.76.67") << url;
    EXPECT_EQ(address->port, 7667) << url;
    EXPECT_EQ(address->ttl, 0) << url;
  }
}

TEST(MulticastAddress, IsNoneWhereTheUrlMakesNoSense) {
  for (const char* url : {"memq://", "udpm://10.0.0.1:7667", "udpm://239.0.0.1:70000",
                          "udpm://239.0.0.1:7667?ttl=300", "udpm://239.0.0.1:7667?ttl=one"})
    EXPECT_FALSE(multicast_address(url)) << url;
}

}  // namespace
}  // namespace voxlist::bus
