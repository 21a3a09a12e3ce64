#include "voxlist/bus/multicast/udp_sockets.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace voxlist::bus {
namespace {

constexpr char kTable[] =
    "   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
    "inode ref pointer drops             \n"
    "  122: 00000000:1DF3 00000000:0000 07 00000000:00010300 00:00000000 00000000     0        0 "
    "26489 2 0000000000000000 7         \n"
    "  not a line\n"
    " 4323: 0100007F:0035 00000000:0000 07 00000000:00000000 00:00000000 00000000   101        0 "
    "18100 2 0000000000000000 0         \n";

TEST(UdpSockets, AreReadFromTheKernelsTable) {
  const std::vector<UdpSocket> sockets = parse_udp_sockets(kTable);
  ASSERT_EQ(sockets.size(), 2U);
  EXPECT_EQ(sockets[0].port, 7667);
  EXPECT_EQ(sockets[0].waiting_bytes, 0x10300);
  EXPECT_EQ(sockets[0].inode, 26489U);
  EXPECT_EQ(sockets[0].dropped_packets, 7);
  EXPECT_EQ(sockets[1].port, 53);
}

// A bound socket that nobody reads.
struct Unread {
  int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  int port = 0;
  sockaddr_in address{};

  Unread() {
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    if (bind(fd, generic, length) == 0 && getsockname(fd, generic, &length) == 0)
      port = ntohs(address.sin_port);
  }
  ~Unread() { close(fd); }

  void send_to_itself(std::size_t bytes) const {
    const std::vector<char> packet(bytes);
    sendto(fd, packet.data(), bytes, 0, reinterpret_cast<const sockaddr*>(&address),
           sizeof address);
  }

  std::uint64_t inode() const {
    struct stat about {};
    fstat(fd, &about);
    return about.st_ino;
  }
};

TEST(UdpSockets, TellWhatWaitsAndWhatWasDropped) {
  const Unread unread;
  if (unread.port == 0) GTEST_SKIP() << "no loopback here";
  for (int i = 0; i < 100; ++i) unread.send_to_itself(50'000);
  const auto sockets = udp_sockets(unread.port);
  if (!sockets) GTEST_SKIP() << "no /proc/net/udp here";
  ASSERT_EQ(sockets->size(), 1U);
  EXPECT_GT(sockets->front().waiting_bytes, 50'000);
  EXPECT_GT(sockets->front().dropped_packets, 0);
  EXPECT_EQ(sockets->front().inode, unread.inode());
}

TEST(UdpSockets, OfThisProcessAreToldFromThoseOfOthers) {
  const Unread unread;
  if (unread.port == 0) GTEST_SKIP() << "no loopback here";
  for (int i = 0; i < 100; ++i) unread.send_to_itself(50'000);
  if (!udp_sockets(unread.port)) GTEST_SKIP() << "no /proc/net/udp here";
  const std::int64_t dropped = dropped_by_own_sockets(unread.port);
  EXPECT_GT(dropped, 0);
  const pid_t other = fork();
  if (other == 0) {
    close(unread.fd);
    _exit(dropped_by_own_sockets(unread.port) == 0 ? 0 : 1);
  }
  int status = -1;
  waitpid(other, &status, 0);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace voxlist::bus
