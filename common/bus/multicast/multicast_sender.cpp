#include "voxlist/bus/multicast/multicast_sender.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include "voxlist/bus/multicast/packets.h"

namespace voxlist::bus {
namespace {

// Messages up to this (bytes) go out at once: 15 of them fit where one large packet does.
constexpr std::size_t kSmall = 4'096;

// More than this (bytes) waits only as one single message: a second and a half of what a network
// takes.
constexpr std::int64_t kMaxQueued = 64'000'000;

// What listeners on other machines can take (bytes/ms), whose buffers nobody here sees: a third of
// what a network of 1 Gbit/s carries.
constexpr std::int64_t kNetworkRate = 40'000;

// Where the kernel tells what listeners have read, that alone sets the pace (bytes/ms).
constexpr std::int64_t kNoRate = 10'000'000;

// Pause before the next look at whether listeners have read: a listener takes about as long for a
// packet.
constexpr std::chrono::microseconds kLook(50);

constexpr std::chrono::seconds kLongestEnd(2);

std::int64_t now_us() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

[[noreturn]] void fail(const char* doing) {
  throw std::runtime_error(std::string("bus: cannot ") + doing + ": " + std::strerror(errno));
}

int open_socket(int ttl) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) fail("open a socket");
  if (setsockopt(fd, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl) == 0) return fd;
  close(fd);
  fail("set the ttl of a socket");
}

sockaddr_in socket_address(const MulticastAddress& address) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(address.port));
  if (inet_pton(AF_INET, address.group.c_str(), &to.sin_addr) != 1)
    throw std::runtime_error("bus: " + address.group + " is no address");
  return to;
}

// One packet at a time, so that listeners are looked at before each.
PacedSender::Options pace(bool listeners_seen) {
  return {.bytes_per_ms = listeners_seen ? kNoRate : kNetworkRate,
          .burst_bytes = 1,
          .max_queued_bytes = INT64_MAX};
}

iovec part(std::span<const std::uint8_t> bytes) {
  return {const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
}

// Signals are for the service's loop: they must find it, and not this thread.
template <class Work>
std::thread start_without_signals(const Work& work) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread(work);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace

struct MulticastSender::Queued {
  std::string channel;
  std::vector<std::uint8_t> bytes;
  Delivery delivery = Delivery::kEvery;
  std::vector<Packet> packets;
  std::size_t sent = 0;  // of the packets
  bool failed = false;
};

MulticastSender::MulticastSender(const MulticastAddress& address)
    : to_(socket_address(address)),
      fd_(open_socket(address.ttl)),
      queue_(pace(address.ttl == 0 && udp_sockets(address.port))) {
  thread_ = start_without_signals([this] { work(); });
}

MulticastSender::~MulticastSender() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
  close(fd_);
}

bool MulticastSender::send(const std::string& channel, std::span<const std::uint8_t> message,
                           Delivery delivery) {
  const std::lock_guard lock(mutex_);
  if (message.size() > kSmall || waiting_.contains(channel))
    return queue(channel, message, delivery);
  return send_packet(packets_of(channel, message, number_++).front());
}

bool MulticastSender::queue(const std::string& channel, std::span<const std::uint8_t> message,
                            Delivery delivery) {
  if (delivery == Delivery::kLatest && replace_waiting(channel, message)) return true;
  const auto size = static_cast<std::int64_t>(message.size());
  if (!queue_.idle() && queued_bytes_ + size > kMaxQueued) return false;
  const auto queued = std::make_shared<Queued>();
  queued->channel = channel;
  queued->delivery = delivery;
  write(message, *queued);
  Channel& waiting = waiting_[channel];
  ++waiting.messages;
  waiting.newest = queued;
  queue_.push(queued->packets.front().size(), [this, queued] { send_next_packet(queued); });
  changed_.notify_one();
  return true;
}

bool MulticastSender::replace_waiting(const std::string& channel,
                                      std::span<const std::uint8_t> message) {
  const auto waiting = waiting_.find(channel);
  if (waiting == waiting_.end()) return false;
  Queued& newest = *waiting->second.newest;
  if (newest.delivery != Delivery::kLatest || newest.sent > 0) return false;
  queued_bytes_ -= static_cast<std::int64_t>(newest.bytes.size());
  write(message, newest);
  ++superseded_;
  return true;
}

void MulticastSender::write(std::span<const std::uint8_t> message, Queued& queued) {
  queued.bytes.assign(message.begin(), message.end());
  queued.packets = packets_of(queued.channel, queued.bytes, number_++);
  queued_bytes_ += static_cast<std::int64_t>(message.size());
}

void MulticastSender::send_next_packet(const std::shared_ptr<Queued>& message) {
  // Without one of its packets no other is of use.
  if (!message->failed) message->failed = !send_packet(message->packets[message->sent]);
  if (++message->sent == message->packets.size()) return finish(*message);
  queue_.push_first(message->packets[message->sent].size(),
                    [this, message] { send_next_packet(message); });
}

void MulticastSender::finish(const Queued& message) {
  if (message.failed) ++failed_;
  queued_bytes_ -= static_cast<std::int64_t>(message.bytes.size());
  const auto waiting = waiting_.find(message.channel);
  if (--waiting->second.messages == 0) waiting_.erase(waiting);
}

bool MulticastSender::send_packet(const Packet& packet) const {
  iovec parts[] = {part(packet.head), part(packet.body)};
  sockaddr_in to = to_;
  msghdr message{};
  message.msg_name = &to;
  message.msg_namelen = sizeof to;
  message.msg_iov = parts;
  message.msg_iovlen = 2;
  ssize_t sent = 0;
  do {
    sent = sendmsg(fd_, &message, MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  return sent == static_cast<ssize_t>(packet.size());
}

void MulticastSender::work() {
  std::unique_lock lock(mutex_);
  while (wait_for_work(lock)) {
    if (listeners_have_room()) queue_.run(now_us());
    lock.unlock();
    std::this_thread::sleep_for(kLook);
    lock.lock();
  }
}

bool MulticastSender::wait_for_work(std::unique_lock<std::mutex>& lock) {
  changed_.wait(lock, [this] { return ending_ || !queue_.idle(); });
  if (!ending_) return true;
  if (!end_us_) end_us_ = now_us() + std::chrono::microseconds(kLongestEnd).count();
  return !queue_.idle() && now_us() < *end_us_;
}

bool MulticastSender::listeners_have_room() {
  const auto listeners = udp_sockets(ntohs(to_.sin_port));
  return !listeners || room_.is_there(*listeners, now_us());
}

std::int64_t MulticastSender::queued_bytes() const {
  const std::lock_guard lock(mutex_);
  return queued_bytes_;
}

}  // namespace voxlist::bus
