#include "voxlist/fleet/throttle.h"

#include <algorithm>

namespace voxlist::fleet {

// A rate below one a second has the first message for nothing.
Throttle::Throttle(double max_hz, double max_bytes_per_s)
    : max_hz_(max_hz),
      max_bytes_per_s_(max_bytes_per_s),
      messages_(std::max(1.0, max_hz)),
      bytes_(max_bytes_per_s) {}

bool Throttle::pass(std::size_t bytes, std::int64_t now_us) {
  earn(now_us);
  if (messages_ < 1.0 || bytes_ <= 0.0) return false;
  messages_ -= 1.0;
  bytes_ -= static_cast<double>(bytes);
  return true;
}

void Throttle::earn(std::int64_t now_us) {
  const double passed_s =
      last_us_ ? static_cast<double>(std::max<std::int64_t>(0, now_us - *last_us_)) * 1e-6 : 0.0;
  last_us_ = now_us;
  messages_ = std::min(messages_ + passed_s * max_hz_, std::max(1.0, max_hz_));
  bytes_ = std::min(bytes_ + passed_s * max_bytes_per_s_, max_bytes_per_s_);
}

}  // namespace voxlist::fleet
