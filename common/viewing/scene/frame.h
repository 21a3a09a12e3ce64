#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace voxlist::viewing {

/// What goes to a client as one WebSocket message: the length of a JSON text (uint32, a multiple of
/// 4), the text, filled up with spaces, and bytes whose meaning the text tells. Little-endian.
using Frame = std::vector<std::uint8_t>;

Frame frame_of(std::string json, std::span<const std::uint8_t> bytes = {});

}  // namespace voxlist::viewing
