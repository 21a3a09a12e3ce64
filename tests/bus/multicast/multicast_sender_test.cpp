// Over UDP, in a private network: each test starts the disabled one with its name there.
#include "voxlist/bus/multicast/multicast_sender.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <lcm/lcm-cpp.hpp>
#include <numeric>
#include <thread>
#include <voxlist/pointcloud_t.hpp>

#include "tests/bus/private_network.h"
#include "voxlist/bus/bus.h"

namespace voxlist::bus {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr char kLcmUrl[] = "udpm://239.255.76.67:7667?ttl=0";
// What a service gets where the kernel gives no more than Debian's default.
constexpr char kDefaultBuffer[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=212992";

void run_there(const std::string& test) {
  if (!has_private_networks()) GTEST_SKIP() << "no private network namespaces here";
  EXPECT_EQ(run_in_private_network(kWithMulticast, "MulticastSenderThere.DISABLED_" + test), 0);
}

TEST(MulticastSender, SendsTheBytesThatLcmSends) { run_there("SendsTheBytesThatLcmSends"); }
TEST(MulticastSender, LosesNothingWithTheDefaultBuffer) {
  run_there("LosesNothingWithTheDefaultBuffer");
}
TEST(MulticastSender, LeavesWhatWaitsForTheNewest) { run_there("LeavesWhatWaitsForTheNewest"); }
TEST(MulticastSender, DoesNotWaitForAListenerThatIsStopped) {
  run_there("DoesNotWaitForAListenerThatIsStopped");
}

// Hears packets, not messages.
class Ear {
 public:
  Ear() {
    const int yes = 1;
    setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(7667);
    EXPECT_EQ(bind(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    ip_mreq group{.imr_multiaddr = {inet_addr("239.255.76.67")}, .imr_interface = {INADDR_ANY}};
    EXPECT_EQ(setsockopt(fd_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group), 0);
    const timeval patience{.tv_sec = 10, .tv_usec = 0};
    setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  ~Ear() { close(fd_); }

  std::vector<Bytes> hear(std::size_t packets) {
    std::vector<Bytes> heard(packets, Bytes(70'000));
    for (Bytes& packet : heard) {
      const ssize_t size = recv(fd_, packet.data(), packet.size(), 0);
      packet.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
    }
    return heard;
  }

 private:
  int fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
};

TEST(MulticastSenderThere, DISABLED_SendsTheBytesThatLcmSends) {
  Ear ear;
  MulticastSender ours{MulticastAddress{}};
  lcm::LCM lcms(kLcmUrl);
  // Channel and its zero take 6 B: the largest of one packet, and of two; more around them.
  for (const std::size_t size : {0, 10, 5000, 65'493, 65'494, 130'968, 130'969, 150'000}) {
    Bytes message(size);
    std::iota(message.begin(), message.end(), std::uint8_t{0});
    const std::size_t packets = packets_of("CLOUD", message, 0).size();
    lcms.publish("CLOUD", message.data(), static_cast<unsigned>(size));
    const std::vector<Bytes> expected = ear.hear(packets);
    ASSERT_TRUE(ours.send("CLOUD", message));
    EXPECT_EQ(ear.hear(packets), expected) << size << " B";
  }
}

pointcloud_t numbered_cloud(std::int32_t seq, std::size_t points) {
  pointcloud_t cloud{};
  cloud.seq = seq;
  cloud.n_points = static_cast<std::int32_t>(points);
  cloud.points.assign(points, {1.0F, 2.0F, 3.0F});
  cloud.n_channels = 3;
  cloud.channel_names = {"origin_x", "origin_y", "origin_z"};
  cloud.channels.assign(3, std::vector<float>(points));
  return cloud;
}

// Large ones, and after each a small one of the same channel.
constexpr int kClouds = 50;

std::vector<std::int32_t> hear_as_service(std::atomic<int>& ready) {
  BusOptions options;
  options.url = kDefaultBuffer;
  Bus bus(options);
  std::vector<std::int32_t> heard;
  bus.subscribe(kCloud, [&](const pointcloud_t& cloud) { heard.push_back(cloud.seq); });
  ++ready;
  for (int i = 0; i < 2000 && std::ssize(heard) < kClouds; ++i)
    bus.handle(std::chrono::milliseconds(10));
  return heard;
}

std::vector<std::int32_t> hear_as_others(std::atomic<int>& ready) {
  lcm::LCM lcm(kLcmUrl);
  std::vector<std::int32_t> heard;
  using Heard = std::vector<std::int32_t>*;
  lcm.subscribeFunction(
         "CLOUD",
         +[](const lcm::ReceiveBuffer*, const std::string&, const pointcloud_t* cloud, Heard all) {
           all->push_back(cloud->seq);
         },
         &heard)
      ->setQueueCapacity(0);
  ++ready;
  for (int i = 0; i < 2000 && std::ssize(heard) < kClouds; ++i) lcm.handleTimeout(10);
  return heard;
}

TEST(MulticastSenderThere, DISABLED_LosesNothingWithTheDefaultBuffer) {
  std::atomic<int> ready = 0;
  std::vector<std::int32_t> heard[4];
  std::vector<std::thread> listeners;
  for (int i = 0; i < 3; ++i) listeners.emplace_back([&, i] { heard[i] = hear_as_service(ready); });
  listeners.emplace_back([&] { heard[3] = hear_as_others(ready); });
  while (ready < 4) std::this_thread::yield();
  Bus bus(BusOptions{});
  for (int i = 0; i < kClouds; ++i)
    bus.publish(kCloud, numbered_cloud(i, i % 2 == 0 ? 100'000 : 10));
  for (std::thread& listener : listeners) listener.join();
  std::vector<std::int32_t> all(kClouds);
  std::iota(all.begin(), all.end(), 0);
  for (const auto& one : heard) EXPECT_EQ(one, all);
}

// While a listener does not read: one message is being sent, and one waits.
TEST(MulticastSenderThere, DISABLED_LeavesWhatWaitsForTheNewest) {
  Ear ear;
  MulticastSender sender{MulticastAddress{}};
  constexpr std::uint8_t kMessages = 20;
  constexpr std::size_t kSize = 400'000;
  for (std::uint8_t i = 0; i < kMessages; ++i)
    ASSERT_TRUE(sender.send("CLOUD", Bytes(kSize, i), Delivery::kLatest));
  EXPECT_LE(sender.queued_bytes(), 2 * static_cast<std::int64_t>(kSize));
  ASSERT_GE(sender.superseded(), kMessages - 2);
  ASSERT_LT(sender.superseded(), kMessages);
  const auto sent = static_cast<std::size_t>(kMessages - sender.superseded());
  const std::vector<Bytes> heard = ear.hear(sent * packets_of("CLOUD", Bytes(kSize), 0).size());
  ASSERT_FALSE(heard.back().empty());
  EXPECT_EQ(heard.back().back(), kMessages - 1);
  ASSERT_TRUE(sender.send("CLOUD", Bytes(kSize, 1)));
  ASSERT_TRUE(sender.send("CLOUD", Bytes(kSize, 2), Delivery::kLatest));
  EXPECT_EQ(sender.superseded(), kMessages - static_cast<std::int64_t>(sent))
      << "what was not sent so stays";
}

TEST(MulticastSenderThere, DISABLED_DoesNotWaitForAListenerThatIsStopped) {
  const Ear stopped;
  Ear ear;
  MulticastSender sender{MulticastAddress{}};
  const Bytes message(3'000'000);
  const std::size_t packets = packets_of("CLOUD", message, 0).size();
  ASSERT_TRUE(sender.send("CLOUD", message));
  std::size_t heard = 0;
  for (const Bytes& packet : ear.hear(packets)) heard += packet.empty() ? 0 : 1;
  EXPECT_EQ(heard, packets);
}

}  // namespace
}  // namespace voxlist::bus
