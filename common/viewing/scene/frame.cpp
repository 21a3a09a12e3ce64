#include "voxlist/viewing/scene/frame.h"

#include <cstring>

namespace voxlist::viewing {

Frame frame_of(std::string json, std::span<const std::uint8_t> bytes) {
  json.append((4 - json.size() % 4) % 4, ' ');
  const auto length = static_cast<std::uint32_t>(json.size());
  Frame frame(sizeof length + json.size() + bytes.size());
  std::memcpy(frame.data(), &length, sizeof length);
  std::memcpy(frame.data() + sizeof length, json.data(), json.size());
  if (!bytes.empty())
    std::memcpy(frame.data() + sizeof length + json.size(), bytes.data(), bytes.size());
  return frame;
}

}  // namespace voxlist::viewing
