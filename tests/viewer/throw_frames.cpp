// Throws random WebSocket frames at a viewer, on the page's protocol and on Foxglove's, and looks
// whether it still serves. Arguments, each optional: how many frames (20,000); seed (1). Run by
// hand with a sanitizer: tests/bench/README.md.
#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <voxlist/pose_t.hpp>

#include "services/viewer/viewer_service.h"
#include "voxlist/bus/bus.h"
#include "voxlist/bus/convert.h"
#include "voxlist/bus/health.h"
#include "voxlist/system/file_descriptor.h"

namespace {

using namespace voxlist;

// Texts that mean something to one of the protocols, or nearly so.
constexpr const char* kTexts[] = {
    R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1},{"id":2,"channelId":2}]})",
    R"({"op":"unsubscribe","subscriptionIds":[1,2,99999999999]})",
    R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1e300}]})",
    R"({"op":"advertise","channels":[]})",
    R"({"op":"getParameters","parameterNames":[],"id":"x"})",
    R"([[[[[[[[[[[[[[[[[[[[{}]]]]]]]]]]]]]]]]]]]])",
    "space on",
    "space off",
    ""};

class Thrower {
 public:
  explicit Thrower(unsigned seed) : random_(seed) {
    config_.port = 0;
    viewer_.emplace(bus_, health_, config_);
  }

  // Throws `count` frames, then asks for the page. Whether that came.
  bool run(long count) {
    for (long i = 0; i < count; ++i) {
      if (!is_open_ || is_one_of(2000)) open();
      send_bytes(frame());
      serve(1 + static_cast<int>(random_() % 3));
      if (i % 50 == 0) say_something();
    }
    return serves_the_page();
  }

  long lines() const { return lines_; }

 private:
  bool is_one_of(unsigned many) { return random_() % many == 0; }

  void serve(int ticks) {
    char buffer[65'536];
    for (int i = 0; i < ticks; ++i) {
      bus_.handle(std::chrono::milliseconds(0));
      viewer_->tick(now_us_ += 20'000);
      const ssize_t got = recv(line_.get(), buffer, sizeof buffer, 0);
      if (got == 0) is_open_ = false;
      if (got > 0) heard_.append(buffer, static_cast<std::size_t>(got));
    }
    if (heard_.size() > 4096) heard_.erase(0, heard_.size() - 1024);
  }

  // So that there is something to subscribe to.
  void say_something() {
    const StampedPose2 pose{now_us_, Pose2{1e-7 * static_cast<double>(now_us_), 0.0, 0.0}};
    bus_.publish(bus::kPose, bus::to_message(pose));
    bus_.publish(bus::kOdometry, bus::to_message(pose));
  }

  void connect_to_viewer() {
    line_ = FileDescriptor(socket(AF_INET, SOCK_STREAM, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(viewer_->port());
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_open_ = connect(line_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    fcntl(line_.get(), F_SETFL, O_NONBLOCK);
    heard_.clear();
    ++lines_;
  }

  void open() {
    connect_to_viewer();
    const bool is_live = is_one_of(2);
    const std::string own = "127.0.0.1:" + std::to_string(viewer_->port());
    send_bytes(std::string("GET ") + (is_live ? "/live" : "/") + " HTTP/1.1\r\nHost: " + own +
               "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Protocol: " +
               (is_live ? "voxlist.live.v1" : "foxglove.sdk.v1") + "\r\n\r\n");
    for (int i = 0; i < 20 && heard_.find("\r\n\r\n") == std::string::npos; ++i) serve(1);
  }

  void send_bytes(const std::string& bytes) {
    if (send(line_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0 && errno != EAGAIN)
      is_open_ = false;
  }

  // Mostly a frame that is well formed; else any bytes, or such a frame with some of them changed.
  std::string frame() {
    if (is_one_of(40)) return random_bytes(1 + random_() % 64);
    std::string frame = well_formed();
    if (is_one_of(20))
      for (int i = 0; i < 3; ++i) frame[random_() % frame.size()] = static_cast<char>(random_());
    return frame;
  }

  std::string well_formed() {
    static constexpr unsigned char kKinds[] = {0x82, 0x82, 0x82, 0x81, 0x81, 0x81, 0x81,
                                               0x89, 0x8a, 0x02, 0x01, 0x80, 0x00};
    const bool is_end = is_one_of(500);
    const unsigned char kind = is_end ? 0x88 : kKinds[random_() % std::size(kKinds)];
    const bool is_control = (kind & 0x08) != 0;
    std::string payload = (kind & 0x0f) == 1 ? text() : random_bytes(length(is_control));
    if (is_control) payload.resize(std::min<std::size_t>(payload.size(), 125));
    std::string frame(1, static_cast<char>(kind));
    append_length(payload.size(), frame);
    const std::string mask = random_bytes(4);
    frame += mask;
    for (std::size_t i = 0; i < payload.size(); ++i)
      frame += static_cast<char>(payload[i] ^ mask[i % 4]);
    return frame;
  }

  static void append_length(std::size_t size, std::string& frame) {
    const int bytes = size < 126 ? 0 : size < 65'536 ? 2 : 8;
    frame += static_cast<char>(0x80 | (bytes == 0 ? size : bytes == 2 ? 126 : 127));
    for (int i = bytes - 1; i >= 0; --i) frame += static_cast<char>(size >> (8 * i));
  }

  std::size_t length(bool is_control) {
    if (is_control) return random_() % 126;
    if (is_one_of(1000)) return random_() % 70'000;
    return random_() % 200;
  }

  std::string text() {
    std::string text = kTexts[random_() % std::size(kTexts)];
    if (is_one_of(3) && !text.empty())
      text[random_() % text.size()] = static_cast<char>(32 + random_() % 95);
    if (is_one_of(5)) text.resize(random_() % (text.size() + 1));
    return text;
  }

  std::string random_bytes(std::size_t size) {
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random_());
    return bytes;
  }

  bool serves_the_page() {
    connect_to_viewer();
    send_bytes("GET / HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(viewer_->port()) + "\r\n\r\n");
    for (int i = 0; i < 100 && heard_.find("<title>Voxlist") == std::string::npos; ++i) serve(1);
    return heard_.find("<title>Voxlist") != std::string::npos;
  }

  bus::Bus bus_{{.url = "memq://", .prefix = ""}};
  bus::Health health_{"viewer"};
  services::ViewerServiceConfig config_;
  std::optional<services::ViewerService> viewer_;
  std::mt19937 random_;
  FileDescriptor line_{-1};
  std::string heard_;
  bool is_open_ = false;
  std::int64_t now_us_ = 10'000'000;
  long lines_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::atol(argv[1]) : 20'000;
  const int seed = argc > 2 ? std::atoi(argv[2]) : 1;
  Thrower thrower(static_cast<unsigned>(seed));
  const bool serves = thrower.run(count);
  std::printf("%ld frames on %ld lines, seed %d: %s\n", count, thrower.lines(), seed,
              serves ? "it serves" : "it does not serve any more");
  return serves ? 0 : 1;
}
