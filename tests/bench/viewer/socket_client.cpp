#include "tests/bench/viewer/socket_client.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <vector>

namespace voxlist::bench {
namespace {

constexpr std::string_view kChannel = "\"id\":";

}  // namespace

SocketClient::SocketClient(std::uint16_t port, std::string_view target, std::string_view protocol)
    : is_foxglove_(target == "/"), line_(socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(line_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("no viewer");
  fcntl(line_.get(), F_SETFL, O_NONBLOCK);
  const std::string request =
      "GET " + std::string(target) + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
      "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Protocol: " +
      std::string(protocol) + "\r\n\r\n";
  send(line_.get(), request.data(), request.size(), MSG_NOSIGNAL);
}

void SocketClient::read() {
  static std::vector<char> buffer(1 << 20);
  for (ssize_t got = 1; got > 0;) {
    got = recv(line_.get(), buffer.data(), buffer.size(), 0);
    if (got <= 0) return;
    bytes_ += static_cast<std::size_t>(got);
    is_open_ = true;
    if (is_foxglove_) subscribe({buffer.data(), static_cast<std::size_t>(got)});
  }
}

// An advertisement is JSON in a frame of its own; nothing else has an "id".
void SocketClient::subscribe(std::string_view heard) {
  const std::string text = tail_ + std::string(heard);
  std::size_t at = text.find(kChannel);
  for (; at != std::string::npos && at + 16 < text.size(); at = text.find(kChannel, at + 1)) {
    const int channel = std::atoi(text.c_str() + at + kChannel.size());
    if (!subscribed_.insert(channel).second) continue;
    const std::string number = std::to_string(channel);
    send_text(R"({"op":"subscribe","subscriptions":[{"id":)" + number + R"(,"channelId":)" +
              number + "}]}");
  }
  tail_ = text.substr(text.size() - std::min<std::size_t>(text.size(), 16));
}

// Masked with zeros.
void SocketClient::send_text(const std::string& text) {
  std::string frame{static_cast<char>(0x81), static_cast<char>(0x80 | text.size())};
  frame += std::string(4, '\0') + text;
  send(line_.get(), frame.data(), frame.size(), MSG_NOSIGNAL);
}

}  // namespace voxlist::bench
