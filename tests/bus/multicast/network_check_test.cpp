#include "voxlist/bus/multicast/network_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bus/private_network.h"

namespace voxlist::bus {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kAsked = 8'000'000;

MulticastAddress address(int ttl) { return {.port = 7667, .ttl = ttl}; }

// A machine with nothing to complain of.
NetworkFacts good() { return {NetworkInterface{.name = "eth0"}, kAsked, 16'000'000}; }

NetworkFacts with(const NetworkInterface& interface) {
  NetworkFacts facts = good();
  facts.interface = interface;
  return facts;
}

auto tells(const char* key, const char* what) {
  return ElementsAre(AllOf(Field(&NetworkFinding::key, key), Field(&NetworkFinding::is_fault, true),
                           Field(&NetworkFinding::sentence, HasSubstr(what))));
}

auto notes(const char* key, const char* what) {
  return ElementsAre(AllOf(Field(&NetworkFinding::key, key),
                           Field(&NetworkFinding::is_fault, false),
                           Field(&NetworkFinding::sentence, HasSubstr(what))));
}

std::vector<NetworkFinding> findings(const NetworkFacts& facts, int ttl = 1) {
  return network_findings(address(ttl), facts, kAsked);
}

TEST(NetworkCheck, HasNothingToSayOfOneMachineOrAGoodNetwork) {
  EXPECT_THAT(findings({}, 0), IsEmpty());
  EXPECT_THAT(findings(good()), IsEmpty());
}

TEST(NetworkCheck, TellsOfRoutesThatLeadNowhere) {
  EXPECT_THAT(
      findings(
          with({.name = "lo", .is_loopback = true, .has_multicast = false, .mtu_bytes = 65'536})),
      tells("route", "loopback"));
  NetworkFacts none = good();
  none.interface.reset();
  EXPECT_THAT(findings(none), tells("route", "no route"));
}

TEST(NetworkCheck, TellsOfInterfacesThatCarryNothing) {
  EXPECT_THAT(findings(with({.name = "wlan0", .is_up = false})),
              tells("interface", "ip link set dev wlan0 up"));
  EXPECT_THAT(findings(with({.name = "wg0", .has_multicast = false})),
              tells("interface", "ip link set dev wg0 multicast on"));
  EXPECT_THAT(findings(with({.name = "eth0", .is_connected = false})),
              tells("interface", "eth0 is not connected"));
}

TEST(NetworkCheck, TellsOfAnUnusualMtu) {
  EXPECT_THAT(findings(with({.name = "wg0", .mtu_bytes = 1280})),
              tells("mtu", "any of its 53 pieces, which are 45 with the usual 1500"));
  EXPECT_THAT(findings(with({.name = "eth0", .mtu_bytes = 9000})), notes("mtu", "9000"));
}

TEST(NetworkCheck, TellsOfRoutersThatMessagesPass) {
  EXPECT_THAT(findings(good(), 3), notes("ttl", "pass up to 2 routers"));
}

TEST(NetworkCheck, TellsOfBuffersThatAreTooSmall) {
  NetworkFacts facts = good();
  facts.receive_buffer_bytes = 212'992;
  EXPECT_THAT(findings(facts), tells("receive_buffer", "sysctl -w net.core.rmem_max=8000000"));
  facts = good();
  facts.fragment_room_bytes = 4'194'304;
  EXPECT_THAT(findings(facts), tells("fragments", "ipfrag_high_thresh"));
  facts.fragment_room_bytes.reset();
  EXPECT_THAT(findings(facts), IsEmpty());
}

TEST(NetworkCheck, SaysWhereMessagesGo) {
  EXPECT_EQ(network_summary(address(1), good()),
            "messages for other machines leave by eth0, MTU 1500, receive buffer 8000 kB");
  EXPECT_THAT(network_summary(address(0), good()), HasSubstr("stay on this machine"));
  EXPECT_THAT(network_summary(address(1), {}), HasSubstr("no way"));
}

TEST(NetworkCheck, KnowsWhatTheKernelGives) {
  EXPECT_EQ(network_facts(address(1), 10'000).receive_buffer_bytes, 10'000);
  EXPECT_LT(network_facts(address(1), 2'000'000'000).receive_buffer_bytes, 2'000'000'000);
  EXPECT_FALSE(network_interface("no_such_thing"));
  EXPECT_FALSE(network_interface("a_name_that_is_too_long"));
}

TEST(NetworkCheck, DISABLED_OnTheLoopback) {
  const NetworkFacts facts = network_facts(address(1), 1);
  ASSERT_TRUE(facts.interface);
  EXPECT_TRUE(facts.interface->is_loopback);
}

TEST(NetworkCheck, DISABLED_OnAnInterface) {
  const NetworkFacts facts = network_facts(address(1), 1);
  ASSERT_TRUE(facts.interface);
  EXPECT_EQ(facts.interface->name, "va");
  EXPECT_EQ(facts.interface->mtu_bytes, 1280);
  EXPECT_TRUE(facts.interface->is_up);
  EXPECT_FALSE(facts.interface->is_connected);
  EXPECT_FALSE(facts.interface->has_multicast);
  EXPECT_FALSE(facts.interface->is_loopback);
}

TEST(NetworkCheck, SeesRealInterfaces) {
  if (!has_private_networks()) GTEST_SKIP() << "no private network namespaces here";
  EXPECT_EQ(run_in_private_network(kWithMulticast, "NetworkCheck.DISABLED_OnTheLoopback"), 0);
  const std::string setup =
      "ip link set lo up && ip link add name va type veth peer name vb && ip address add "
      "10.0.0.1/24 dev va && ip link set va mtu 1280 multicast off up && ip route add 224.0.0.0/4 "
      "dev va &&";
  EXPECT_EQ(run_in_private_network(setup, "NetworkCheck.DISABLED_OnAnInterface"), 0);
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
