#include "voxlist/bus/multicast/listener_room.h"

#include <utility>

namespace voxlist::bus {

bool ListenerRoom::is_there(const std::vector<UdpSocket>& listeners, std::int64_t now_us) {
  std::map<std::uint64_t, std::int64_t> full_since_us;
  bool room = true;
  for (const UdpSocket& listener : listeners) {
    if (listener.waiting_bytes <= kMaxWaiting) continue;
    const auto known = full_since_us_.find(listener.inode);
    const std::int64_t since_us = known == full_since_us_.end() ? now_us : known->second;
    full_since_us[listener.inode] = since_us;
    room &= now_us - since_us >= kPatience_us;
  }
  full_since_us_ = std::move(full_since_us);
  return room;
}

}  // namespace voxlist::bus
