#include "voxlist/fleet/repeats.h"

#include <algorithm>

namespace voxlist::fleet {
namespace {

// FNV-1a, of 64 bits.
std::uint64_t hash_of(bus::Bytes bytes) {
  std::uint64_t hash = 14695981039346656037U;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 1099511628211U;
  return hash;
}

}  // namespace

bool Repeats::is_repeat(bus::Bytes bytes, std::int64_t now_us) {
  while (!seen_.empty() && now_us - seen_.front().at_us > kRemembered_us) seen_.pop_front();
  const std::uint64_t hash = hash_of(bytes);
  if (std::ranges::any_of(seen_, [hash](const Seen& seen) { return seen.hash == hash; }))
    return true;
  if (seen_.size() >= kRemembered) seen_.pop_front();
  seen_.push_back({hash, now_us});
  return false;
}

}  // namespace voxlist::fleet
