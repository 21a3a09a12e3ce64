#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxlist/viewing/scene/frame.h"

namespace voxlist::viewing {

/// Where a server listens.
struct ServerOptions {
  /// Address in numbers. Others than 127.0.0.1 and ::1 let in whoever reaches the machine.
  std::string address = "127.0.0.1";
  /// 0: any that is free.
  std::uint16_t port = 0;
  /// A socket that listens already, made by whoever started this process; -1: there is none.
  int listening_fd = -1;
};

/// What becomes of a command.
struct CommandAnswer {
  /// 204: done; 400: it says nothing that can be done; 409: not now.
  unsigned status = 204;
  std::string sentence;
};

/// One WebSocket message.
struct SocketMessage {
  std::string bytes;
  bool is_text = false;
};

/// Another WebSocket protocol on the same port, for other people's viewers: they look on.
struct ForeignProtocol {
  /// Clients ask for it by one of these.
  std::vector<std::string> names{};
  /// Pages elsewhere that may speak it.
  std::vector<std::string> origins{};
  /// They are called as the owner's are.
  std::function<int()> open{};
  std::function<void(int)> close{};
  std::function<std::optional<SocketMessage>(int)> next{};
  /// What a client says.
  std::function<void(int, std::string_view bytes, bool is_text)> hear{};
};

/// What the server asks its owner. All calls come from within poll().
struct ServerOwner {
  /// A client comes, and gets a number.
  std::function<int()> open;
  std::function<void(int)> close;
  /// What a client is to be sent next; nothing: it has all.
  std::function<std::optional<Frame>(int)> next;
  std::function<CommandAnswer(const std::string& name, const std::string& json)> command;
  ForeignProtocol foreign{};
  /// What a client says on its stream: any text. It is never an order.
  std::function<void(int, std::string_view text)> hear = [](int, std::string_view) {};
};

/// HTTP and WebSocket on one port: the page's files, the stream, the commands. What it refuses is
/// in rules.h. At most 8 clients and 64 connections; a request has 10 s to be whole; a client that
/// takes nothing for 30 s is let go. It holds one frame a client.
class WebServer {
 public:
  /// Throws std::runtime_error that says what and where when it cannot listen.
  WebServer(const ServerOptions& options, ServerOwner owner);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Does all that can be done now, and never waits.
  void poll();

  std::uint16_t port() const;
  int clients() const;
  /// Requests that were refused so far.
  std::int64_t refused() const;
  /// What a command must carry. Another one for each server.
  const std::string& token() const;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

/// Whether it is an address in numbers, such as 127.0.0.1.
bool is_address(const std::string& address);

/// Whether an address means this machine alone.
bool is_loopback(const std::string& address);

/// The listening socket that LISTEN_FDS hands to this process (as systemd does, and `voxlist
/// listen`); -1 where there is none.
int inherited_socket();

}  // namespace voxlist::viewing
