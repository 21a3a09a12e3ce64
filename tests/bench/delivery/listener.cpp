#include "tests/bench/delivery/listener.h"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <voxlist/pointcloud_t.hpp>

#include "voxlist/bus/bus.h"

namespace voxlist::bench {
namespace {

constexpr char kUrl[] = "udpm://239.255.76.67:7667?ttl=0";
// What a service gets where net.core.rmem_max is Debian's.
constexpr char kSmallBuffer[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=212992";

std::int64_t now_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

bool readable(int fd) {
  pollfd wanted{.fd = fd, .events = POLLIN, .revents = 0};
  return poll(&wanted, 1, 0) != 0;
}

void say_ready(int to) {
  const char ready = 1;
  if (write(to, &ready, 1) != 1) _exit(1);
}

void listen_plain(int from, int to, Heard& heard) {
  lcm::LCM lcm(kUrl);
  const auto take = [](const lcm::ReceiveBuffer*, const std::string&, const pointcloud_t* cloud,
                       Heard* all) { all->delays_us.push_back(now_us() - cloud->utime); };
  using Take = void (*)(const lcm::ReceiveBuffer*, const std::string&, const pointcloud_t*, Heard*);
  lcm.subscribeFunction("CLOUD", static_cast<Take>(take), &heard);
  say_ready(to);
  while (!readable(from)) lcm.handleTimeout(20);
}

void listen_as_service(int from, int to, Heard& heard) {
  bus::BusOptions options;
  options.url = kSmallBuffer;
  bus::Bus bus(options);
  bus.subscribe(bus::kCloud, [&](const pointcloud_t& cloud) {
    heard.delays_us.push_back(now_us() - cloud.utime);
  });
  say_ready(to);
  while (!readable(from)) bus.handle(std::chrono::milliseconds(20));
}

[[noreturn]] void run(Listener::Kind kind, int from, int to) {
  Heard heard;
  if (kind == Listener::Kind::kLcm) listen_plain(from, to, heard);
  if (kind == Listener::Kind::kBus) listen_as_service(from, to, heard);
  const std::size_t bytes = heard.delays_us.size() * sizeof(std::int64_t);
  _exit(write(to, heard.delays_us.data(), bytes) == static_cast<ssize_t>(bytes) ? 0 : 1);
}

}  // namespace

Listener::Listener(Kind kind) {
  int orders[2];
  int answers[2];
  if (pipe(orders) != 0 || pipe(answers) != 0) throw std::runtime_error("no pipe");
  pid_ = fork();
  if (pid_ == 0) {
    close(orders[1]);
    run(kind, orders[0], answers[1]);
  }
  close(orders[0]);
  close(answers[1]);
  to_ = orders[1];
  from_ = answers[0];
}

void Listener::wait_until_ready() {
  char ready = 0;
  if (read(from_, &ready, 1) != 1) throw std::runtime_error("a listener did not start");
}

Heard Listener::finish() {
  const char end = 0;
  if (write(to_, &end, 1) != 1) throw std::runtime_error("a listener has ended");
  close(to_);
  Heard heard;
  std::int64_t delay_us = 0;
  while (read(from_, &delay_us, sizeof delay_us) == sizeof delay_us)
    heard.delays_us.push_back(delay_us);
  close(from_);
  waitpid(pid_, nullptr, 0);
  return heard;
}

}  // namespace voxlist::bench
