#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace voxlist::fleet {

/// Lets messages pass at a greatest rate, and a greatest number of bytes a second, in the mean of a
/// second: what was not used in the last second may pass at once. A message goes whole, and is paid
/// for before the next.
class Throttle {
 public:
  Throttle(double max_hz, double max_bytes_per_s);

  /// Whether a message of that many bytes may pass now; then it is counted. Time that goes back
  /// earns nothing.
  bool pass(std::size_t bytes, std::int64_t now_us);

 private:
  void earn(std::int64_t now_us);

  const double max_hz_, max_bytes_per_s_;
  double messages_, bytes_;
  std::optional<std::int64_t> last_us_;
};

}  // namespace voxlist::fleet
