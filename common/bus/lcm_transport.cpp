#include <arpa/inet.h>
#include <fmt/core.h>
#include <lcm/lcm.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>

#include "voxlist/bus/bus.h"
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

// The receive buffer that the kernel gives when asked for this much: it clamps silently. Read back
// from a socket, because /proc/sys/net/core does not show the limit inside a network namespace.
int granted_receive_buffer(int bytes) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return bytes;
  int granted = 0;
  socklen_t length = sizeof granted;
  const bool known = setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes) == 0 &&
                     getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &granted, &length) == 0;
  close(fd);
  // The kernel reports twice what it was asked for: half is its own bookkeeping.
  return known ? granted / 2 : bytes;
}

void warn_of_small_buffer(int wanted, std::vector<std::string>& warnings) {
  const int granted = granted_receive_buffer(wanted);
  if (granted >= wanted) return;
  warnings.push_back(
      fmt::format("bus: receive buffer is {} B instead of {} B, large messages may be lost; allow "
                  "more with: sysctl -w net.core.rmem_max={}",
                  granted, wanted, wanted));
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
  }

  void listen(const std::string& channel, int capacity) override {
    // A pattern to lcm: Bus lets no character through that would mean more than itself.
    lcm_subscription_t* subscription = lcm_subscribe(lcm_.get(), channel.c_str(), &hand_over, this);
    if (subscription == nullptr) throw std::runtime_error("bus: cannot subscribe to " + channel);
    lcm_subscription_set_queue_capacity(subscription, capacity);
  }

  bool send(const std::string& channel, Bytes bytes) override {
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

 private:
  static void hand_over(const lcm_recv_buf_t* buffer, const char* channel, void* self) {
    const auto* data = static_cast<const std::uint8_t*>(buffer->data);
    (*static_cast<LcmTransport*>(self)->receiver_)(
        {channel, Bytes(data, buffer->data_size), buffer->recv_utime});
  }

  std::unique_ptr<lcm_t, LcmDeleter> lcm_;
  int fd_ = -1;
  int failures_ = 0;
  const Receiver* receiver_ = nullptr;
};

}  // namespace

std::unique_ptr<Transport> open_lcm(const BusOptions& options, std::vector<std::string>& warnings) {
  const int wanted = options.receive_buffer_bytes;
  if (is_multicast(options.url)) warn_of_small_buffer(wanted, warnings);
  return std::make_unique<LcmTransport>(with_receive_buffer(options.url, wanted));
}

}  // namespace voxlist::bus
