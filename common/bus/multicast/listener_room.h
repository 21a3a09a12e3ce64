#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "voxlist/bus/multicast/udp_sockets.h"

namespace voxlist::bus {

/// Tells when the listeners of this machine have room for one more packet.
class ListenerRoom {
 public:
  /// A listener with more than this waiting (bytes) has to read first. With the largest packet on
  /// top it is still far from the system's default buffer (212,992 B), which other senders use,
  /// too.
  static constexpr std::int64_t kMaxWaiting = 64'000;

  /// A listener that has had no room for so long (us) is stopped or broken. The others do not wait
  /// for it any more, until it reads again.
  static constexpr std::int64_t kPatience_us = 200'000;

  /// Whether all have room, but for those that are stuck.
  bool is_there(const std::vector<UdpSocket>& listeners, std::int64_t now_us);

 private:
  // Listeners without room, by the inode of their socket.
  std::map<std::uint64_t, std::int64_t> full_since_us_;
};

}  // namespace voxlist::bus
