#include "voxlist/serial/edge_text.h"

#include <charconv>
#include <optional>
#include <utility>

namespace voxlist::serial {
namespace {

// Longest line: the digits of 64 bits. What is longer is garbage.
constexpr std::size_t kMaxLine = 20;

}  // namespace

std::vector<std::int64_t> EdgeText::feed(std::int64_t arrival_us,
                                         std::span<const std::uint8_t> bytes) {
  std::vector<std::int64_t> edges_us;
  for (const std::uint8_t byte : bytes) {
    if (byte == '\n') {
      end_line(arrival_us, edges_us);
    } else if (byte != '\r' && line_.size() <= kMaxLine) {
      line_.push_back(static_cast<char>(byte));
    }
  }
  return edges_us;
}

void EdgeText::end_line(std::int64_t arrival_us, std::vector<std::int64_t>& edges_us) {
  const bool whole = std::exchange(whole_, true);
  const std::string line = std::exchange(line_, {});
  std::uint64_t device_us = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), device_us);
  const bool number = error == std::errc() && end == line.data() + line.size();
  // The first line may have lost its beginning.
  if (!whole) return;
  const auto edge_us =
      number ? time_.wall_us(static_cast<std::uint32_t>(device_us), arrival_us) : std::nullopt;
  if (edge_us) edges_us.push_back(*edge_us);
  if (!edge_us) ++garbage_;
}

}  // namespace voxlist::serial
