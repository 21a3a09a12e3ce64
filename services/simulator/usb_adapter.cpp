#include "services/simulator/usb_adapter.h"

#include <algorithm>

namespace voxlist::services {
namespace {

// Data in one packet of an FTDI adapter: 64 bytes, two of which are its own status.
constexpr std::size_t kPacketBytes = 62;

}  // namespace

void UsbAdapter::take(std::span<const std::uint8_t> bytes) {
  held_.insert(held_.end(), bytes.begin(), bytes.end());
}

std::vector<std::uint8_t> UsbAdapter::given_until(std::int64_t utime_us) {
  std::size_t given = held_.size() / kPacketBytes * kPacketBytes;
  const std::int64_t round = latency_us_ > 0 ? utime_us / latency_us_ : round_ + 1;
  if (round != round_) given = held_.size();
  round_ = round;
  const auto end = held_.begin() + static_cast<std::ptrdiff_t>(given);
  std::vector<std::uint8_t> bytes(held_.begin(), end);
  held_.erase(held_.begin(), end);
  return bytes;
}

}  // namespace voxlist::services
