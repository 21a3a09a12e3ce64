#include <arpa/inet.h>
#include <fmt/core.h>
#include <lcm/lcm.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <stdexcept>

#include "voxlist/bus/bus.h"
#include "voxlist/bus/channel_pattern.h"
#include "voxlist/bus/multicast/multicast_sender.h"
#include "voxlist/bus/multicast/network_check.h"
#include "voxlist/bus/transport.h"

namespace voxlist::bus {
namespace {

// More than one in a row can come from a race inside liblcm; this many mean that it is broken.
constexpr int kMaxFailuresInARow = 16;

struct LcmDeleter {
  void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
};

bool is_multicast(const std::string& url) { return url.starts_with("udpm://"); }

std::string with_receive_buffer(const std::string& url, int bytes) {
  if (!is_multicast(url) || url.find("recv_buf_size=") != std::string::npos) return url;
  const char* separator = url.find('?') == std::string::npos ? "?" : "&";
  return fmt::format("{}{}recv_buf_size={}", url, separator, bytes);
}

[[noreturn]] void fail_to_open(const std::string& url) {
  throw std::runtime_error(
      "bus: cannot open " + url +
      (is_multicast(url)
           ? ": is there a route for multicast? On one machine: ip route add 224.0.0.0/4 dev lo "
             "(between machines: dev and the network's interface)"
           : ": use udpm://GROUP:PORT?ttl=N, memq:// or file://PATH"));
}

class LcmTransport : public Transport {
 public:
  explicit LcmTransport(const std::string& url) : lcm_(lcm_create(url.c_str())) {
    if (!lcm_) fail_to_open(url);
    fd_ = lcm_get_fileno(lcm_.get());
    if (fd_ < 0) fail_to_open(url);
    if (const auto address = multicast_address(url)) {
      port_ = address->port;
      is_local_ = address->ttl == 0;
      sender_.emplace(*address);
    }
  }

  void listen(const std::vector<std::string>& patterns, int capacity) override {
    // One subscription: what two patterns match comes once.
    const std::string expression = regular_expression(patterns);
    lcm_subscription_t* subscription =
        lcm_subscribe(lcm_.get(), expression.c_str(), &hand_over, this);
    if (subscription == nullptr) throw std::runtime_error("bus: cannot subscribe to " + expression);
    lcm_subscription_set_queue_capacity(subscription, capacity);
  }

  bool send(const std::string& channel, Bytes bytes, Delivery delivery) override {
    if (sender_) return sender_->send(channel, bytes, delivery);
    return lcm_publish(lcm_.get(), channel.c_str(), bytes.data(),
                       static_cast<unsigned>(bytes.size())) == 0;
  }

  // Polls by itself, so that a signal (EINTR) can be told from a broken connection.
  Received receive(std::chrono::milliseconds timeout, int wake_fd,
                   const Receiver& receiver) override {
    // poll() passes over a negative descriptor.
    pollfd readable[] = {{.fd = fd_, .events = POLLIN, .revents = 0},
                         {.fd = wake_fd, .events = POLLIN, .revents = 0}};
    const int ready = poll(readable, 2, static_cast<int>(timeout.count()));
    if (ready < 0) return errno == EINTR ? Received::kNothing : Received::kEnded;
    if (readable[0].revents == 0) return Received::kNothing;
    receiver_ = &receiver;
    failures_ = lcm_handle(lcm_.get()) == 0 ? 0 : failures_ + 1;
    return failures_ > kMaxFailuresInARow ? Received::kEnded : Received::kMessage;
  }

  int batch() const override { return 256; }

  int file_descriptor() const override { return fd_; }

  Traffic traffic() const override {
    if (!sender_) return {};
    return {.queued_bytes = sender_->queued_bytes(),
            .failed_messages = sender_->failed(),
            .superseded_messages = sender_->superseded(),
            .dropped_packets = dropped_by_own_sockets(port_),
            .incomplete_packets = is_local_ ? 0 : incomplete_packets() - incomplete_before_};
  }

 private:
  static void hand_over(const lcm_recv_buf_t* buffer, const char* channel, void* self) {
    const auto* data = static_cast<const std::uint8_t*>(buffer->data);
    (*static_cast<LcmTransport*>(self)->receiver_)(
        {channel, Bytes(data, buffer->data_size), buffer->recv_utime});
  }

  std::unique_ptr<lcm_t, LcmDeleter> lcm_;
  std::optional<MulticastSender> sender_;  // of udpm:// alone, like its port
  int port_ = 0;
  bool is_local_ = true;
  const std::int64_t incomplete_before_ = incomplete_packets();
  int fd_ = -1;
  int failures_ = 0;
  const Receiver* receiver_ = nullptr;
};

}  // namespace

std::unique_ptr<Transport> open_lcm(const BusOptions& options) {
  const int wanted = options.receive_buffer_bytes;
  return std::make_unique<LcmTransport>(with_receive_buffer(options.url, wanted));
}

}  // namespace voxlist::bus
