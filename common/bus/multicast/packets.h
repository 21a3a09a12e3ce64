#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace voxlist::bus {

/// One UDP packet of a message: `head` and then `body`, which points into the message.
struct Packet {
  std::vector<std::uint8_t> head;
  std::span<const std::uint8_t> body;

  std::size_t size() const { return head.size() + body.size(); }
};

/// A message as LCM sends it: one packet that begins with LC02, or, above 65,499 B of channel and
/// message, fragments that begin with LC03. `number` counts the messages of a sender; listeners
/// tell the fragments of two messages apart by it.
std::vector<Packet> packets_of(const std::string& channel, std::span<const std::uint8_t> message,
                               std::uint32_t number);

}  // namespace voxlist::bus
