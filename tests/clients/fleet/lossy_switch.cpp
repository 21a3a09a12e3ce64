// A switch between hosts, which loses and delays what goes through it: hands each Ethernet frame
// that comes in at one of its ports to all others. Usage: lossy_switch PORT...: network devices of
// this namespace. Reads orders from its standard input, a line each, and writes a line when one is
// done:
//   loss PERCENT         of frames
//   datagram_loss PERCENT  of IP datagrams: all fragments of one are lost together
//   delay MS
//   down PORT, up PORT   what comes from there and what goes there is lost
//   count                writes: passed N lost N down N
// The lost ones follow from their number: a run with the same frames is the same run.
#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <iostream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
using Frame =
    std::vector<std::uint8_t>;  // behind a header that tells of checksums still to be made

// Of a virtio_net_hdr, whose own header file is no C++.
constexpr std::size_t kHeader = 10;

[[noreturn]] void fail(const std::string& what) {
  std::perror(("lossy_switch: " + what).c_str());
  std::exit(1);
}

struct Port {
  std::string name;
  int fd = -1;
  bool up = true;
};

Port open_port(const std::string& name) {
  Port port{name, socket(AF_PACKET, SOCK_RAW, htons(ETH_P_ALL)), true};
  if (port.fd < 0) fail("socket");
  const int on = 1, room = 16'000'000;
  setsockopt(port.fd, SOL_SOCKET, SO_RCVBUFFORCE, &room, sizeof room);
  setsockopt(port.fd, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
  // Devices leave checksums, and the cutting of large packets, to the hardware: the header says
  // what is to do.
  if (setsockopt(port.fd, SOL_PACKET, PACKET_VNET_HDR, &on, sizeof on) != 0)
    fail("PACKET_VNET_HDR");
  if (setsockopt(port.fd, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof on) != 0)
    fail("PACKET_IGNORE_OUTGOING");
  sockaddr_ll at{};
  at.sll_family = AF_PACKET;
  at.sll_protocol = htons(ETH_P_ALL);
  at.sll_ifindex = static_cast<int>(if_nametoindex(name.c_str()));
  if (bind(port.fd, reinterpret_cast<sockaddr*>(&at), sizeof at) != 0) fail(name);
  return port;
}

class Switch {
 public:
  explicit Switch(const std::vector<std::string>& names) {
    for (const std::string& name : names) ports_.push_back(open_port(name));
  }

  void run() {
    std::vector<pollfd> readable(ports_.size() + 1);
    while (true) {
      for (std::size_t i = 0; i < ports_.size(); ++i) readable[i] = {ports_[i].fd, POLLIN, 0};
      readable.back() = {STDIN_FILENO, POLLIN, 0};
      if (poll(readable.data(), readable.size(), wait_ms()) < 0 && errno != EINTR) fail("poll");
      for (std::size_t i = 0; i < ports_.size(); ++i)
        if (readable[i].revents != 0) receive(i);
      if (readable.back().revents != 0 && !obey()) return;
      send_due();
    }
  }

 private:
  struct Waiting {
    Clock::time_point due;
    std::size_t from;
    Frame frame;
  };

  int wait_ms() const {
    if (waiting_.empty()) return 1000;
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(waiting_.front().due - Clock::now());
    return std::max(0, static_cast<int>(left.count()));
  }

  void receive(std::size_t from) {
    Frame frame(kHeader + 70'000);
    ssize_t got = 0;
    while ((got = recv(ports_[from].fd, frame.data(), frame.size(), MSG_DONTWAIT)) > 0) {
      const Frame whole(frame.begin(), frame.begin() + got);
      if (!ports_[from].up) {
        ++down_;
      } else if (is_lost(whole)) {
        ++lost_;
      } else {
        waiting_.push_back({Clock::now() + delay_, from, whole});
      }
    }
  }

  bool is_lost(const Frame& frame) {
    std::uniform_real_distribution<double> percent(0.0, 100.0);
    if (percent(random_) < loss_percent_) return true;
    // Source, identification and seed choose the datagrams that are lost.
    const std::size_t ip = kHeader + ETH_HLEN;
    if (datagram_loss_percent_ <= 0.0 || frame.size() < ip + 20 || frame[ip] >> 4U != 4)
      return false;
    const std::uint32_t key = static_cast<std::uint32_t>(frame[ip + 4]) << 16U |
                              static_cast<std::uint32_t>(frame[ip + 5]) << 8U | frame[ip + 15];
    std::minstd_rand of_datagram(key * 2654435761U % 2147483647U + 1);
    of_datagram.discard(3);
    return percent(of_datagram) < datagram_loss_percent_;
  }

  void send_due() {
    while (!waiting_.empty() && waiting_.front().due <= Clock::now()) {
      const Waiting& next = waiting_.front();
      for (std::size_t to = 0; to < ports_.size(); ++to) {
        if (to == next.from) continue;
        if (!ports_[to].up)
          ++down_;
        else if (send(ports_[to].fd, next.frame.data(), next.frame.size(), 0) < 0)
          ++lost_;
        else
          ++passed_;
      }
      waiting_.pop_front();
    }
  }

  // False: nobody is there any more.
  bool obey() {
    std::string line;
    if (!std::getline(std::cin, line)) return false;
    std::istringstream words(line);
    std::string order, what;
    words >> order >> what;
    if (order == "loss") loss_percent_ = std::atof(what.c_str());
    if (order == "datagram_loss") datagram_loss_percent_ = std::atof(what.c_str());
    if (order == "delay") delay_ = std::chrono::milliseconds(std::atoi(what.c_str()));
    for (Port& port : ports_)
      if (port.name == what) port.up = order == "up";
    if (order == "count")
      std::cout << "passed " << passed_ << " lost " << lost_ << " down " << down_ << std::endl;
    else
      std::cout << line << std::endl;
    return true;
  }

  std::vector<Port> ports_;
  std::deque<Waiting> waiting_;
  std::mt19937 random_{1};
  double loss_percent_ = 0.0, datagram_loss_percent_ = 0.0;
  std::chrono::milliseconds delay_{0};
  std::int64_t passed_ = 0, lost_ = 0, down_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  Switch(std::vector<std::string>(argv + 1, argv + argc)).run();
  return 0;
}
