#include "voxlist/bus/multicast/packets.h"

#include <algorithm>

namespace voxlist::bus {
namespace {

constexpr std::uint32_t kWhole = 0x4c433032;     // "LC02"
constexpr std::uint32_t kFragment = 0x4c433033;  // "LC03"

// What is left of the largest UDP packet (65,507 B) behind the head of 8 or 20 B.
constexpr std::size_t kMaxWhole = 65'499;
constexpr std::size_t kMaxFragment = 65'487;

// Numbers in the network's order, the most significant byte first.
class Head {
 public:
  Head& put(std::uint64_t value, int bytes) {
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
      bytes_.push_back(static_cast<std::uint8_t>(value >> shift));
    return *this;
  }

  // The channel's name counts with the zero behind it.
  Head& put(const std::string& text) {
    bytes_.insert(bytes_.end(), text.c_str(), text.c_str() + text.size() + 1);
    return *this;
  }

  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

std::vector<Packet> packets_of(const std::string& channel, std::span<const std::uint8_t> message,
                               std::uint32_t number) {
  const std::size_t size = channel.size() + 1 + message.size();
  std::vector<Packet> packets;
  if (size <= kMaxWhole) {
    packets.push_back({Head().put(kWhole, 4).put(number, 4).put(channel).take(), message});
    return packets;
  }
  const std::size_t count = (size + kMaxFragment - 1) / kMaxFragment;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Head head;
    head.put(kFragment, 4).put(number, 4).put(message.size(), 4);
    head.put(offset, 4).put(i, 2).put(count, 2);
    if (i == 0) head.put(channel);
    const std::size_t room = kMaxFragment - (i == 0 ? channel.size() + 1 : 0);
    const auto body = message.subspan(offset, std::min(room, message.size() - offset));
    packets.push_back({head.take(), body});
    offset += body.size();
  }
  return packets;
}

}  // namespace voxlist::bus
