#include "voxlist/foreign/websocket/base64.h"

#include <cstdint>

namespace voxlist::foreign {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

// Three bytes as four digits; where fewer are there, the last digits are padding.
void append_group(std::string_view group, std::string& to) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 3; ++i)
    bits = bits << 8 | (i < group.size() ? static_cast<std::uint8_t>(group[i]) : 0U);
  for (std::size_t i = 0; i < 4; ++i)
    to += i <= group.size() ? kDigits[bits >> (18 - 6 * i) & 63] : '=';
}

}  // namespace

std::string base64(std::string_view bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) append_group(bytes.substr(i, 3), text);
  return text;
}

}  // namespace voxlist::foreign
