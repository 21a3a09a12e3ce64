#include "voxlist/bus/multicast/network_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bus/private_network.h"

namespace voxlist::bus {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr MulticastAddress address(int ttl) { return {.port = 7667, .ttl = ttl}; }

TEST(NetworkCheck, HasNothingToSayOfOneMachine) {
  EXPECT_THAT(network_findings(address(0), 2'000'000'000), IsEmpty());
}

TEST(NetworkCheck, TellsOfAReceiveBufferThatIsTooSmall) {
  EXPECT_THAT(network_findings(address(1), 2'000'000'000),
              Contains(HasSubstr("sysctl -w net.core.rmem_max=2000000000")));
  EXPECT_THAT(network_findings(address(1), 1), Not(Contains(HasSubstr("rmem_max"))));
}

TEST(NetworkCheck, DISABLED_TellsOfARouteToTheLoopback) {
  EXPECT_THAT(network_findings(address(1), 1), Contains(HasSubstr("loopback")));
}

TEST(NetworkCheck, DISABLED_IsContentWithARouteToAnInterface) {
  EXPECT_THAT(network_findings(address(1), 1), Not(Contains(HasSubstr("loopback"))));
}

TEST(NetworkCheck, KnowsWhereARouteLeads) {
  if (!has_private_networks()) GTEST_SKIP() << "no private network namespaces here";
  EXPECT_EQ(run_in_private_network(kWithMulticast, "NetworkCheck.DISABLED_TellsOfARoute*"), 0);
  const std::string setup =
      "ip link set lo up && ip link add name va type veth peer name vb && ip address add "
      "10.0.0.1/24 "
      "dev va && ip link set va up && ip link set vb up && ip route add 224.0.0.0/4 dev va &&";
  EXPECT_EQ(run_in_private_network(setup, "NetworkCheck.DISABLED_IsContent*"), 0);
}

TEST(NetworkCheck, TakesTheNarrowestRoute) {
  const std::string table =
      "Iface Destination Gateway Flags RefCnt Use Metric Mask MTU Window IRTT\n"
      "eth0\t00000000\t0100000A\t0003\t0\t0\t0\t00000000\t0\t0\t0\n"
      "lo\t000000E0\t00000000\t0001\t0\t0\t0\t000000F0\t0\t0\t0\n"
      "eth1\t0000000A\t00000000\t0001\t0\t0\t0\t0000FFFF\t0\t0\t0\n";
  EXPECT_EQ(route_device(table, "239.255.76.67"), "lo");
  EXPECT_EQ(route_device(table, "10.0.3.4"), "eth1");
  EXPECT_EQ(route_device(table, "192.168.0.1"), "eth0");
  EXPECT_EQ(route_device("", "192.168.0.1"), "");
}

TEST(NetworkCheck, ReadsHowManyPacketsWereIncomplete) {
  EXPECT_EQ(parse_incomplete_packets("Udp: A ReasmFails\nUdp: 1 2\n"
                                     "Ip: Forwarding ReasmTimeout ReasmFails FragOKs\n"
                                     "Ip: 2 7 41 3\n"),
            41);
  EXPECT_EQ(parse_incomplete_packets("Ip: Forwarding\nIp: 2\n"), 0);
  EXPECT_EQ(parse_incomplete_packets(""), 0);
  EXPECT_GE(incomplete_packets(), 0);
}

}  // namespace
}  // namespace voxlist::bus
