#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "voxlist/system/file_descriptor.h"

namespace voxlist::bench {

/// A WebSocket client of a viewer in the same thread: what it gets is counted and thrown away. One
/// of Foxglove's subscribes to every channel that it is offered.
class SocketClient {
 public:
  /// Connects and asks for the protocol; the answer comes while the viewer ticks.
  SocketClient(std::uint16_t port, std::string_view target, std::string_view protocol);

  /// Reads what is there.
  void read();

  bool is_open() const { return is_open_; }
  std::size_t bytes() const { return bytes_; }

 private:
  void send_text(const std::string& text);
  void subscribe(std::string_view heard);

  const bool is_foxglove_;
  FileDescriptor line_;
  bool is_open_ = false;
  std::size_t bytes_ = 0;
  std::string tail_;  // what may be cut
  std::set<int> subscribed_;
};

}  // namespace voxlist::bench
