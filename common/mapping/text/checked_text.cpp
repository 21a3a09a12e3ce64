#include "voxlist/mapping/text/checked_text.h"

#include <zlib.h>

#include <cstdint>

#include "voxlist/mapping/text/words.h"

namespace voxlist::mapping {
namespace {

constexpr std::string_view kEnd = "# checksum ";

std::uint32_t checksum_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

std::string with_checksum(std::string text) {
  const std::uint32_t checksum = checksum_of(text);
  text += kEnd;
  text += std::to_string(checksum) + '\n';
  return text;
}

std::optional<std::string_view> whole_text(std::string_view text) {
  const std::size_t end = text.rfind(kEnd);
  if (end == std::string_view::npos) return std::nullopt;
  Words last(text.substr(end + kEnd.size()));
  const auto checksum = last.number<std::uint32_t>();
  const std::string_view body = text.substr(0, end);
  return last.good() && checksum == checksum_of(body) ? std::optional(body) : std::nullopt;
}

}  // namespace voxlist::mapping
