#include "voxlist/scanner/lms200/lms200_config.h"

#include <algorithm>
#include <array>

namespace voxlist::scanner {

std::string why_invalid(const Lms200Config& config) {
  constexpr std::array kBauds{9600, 19200, 38400, 500000}, kRanges{8, 16, 32, 80};
  constexpr std::array kResolutions{1.0, 0.5, 0.25};
  if (config.port.empty()) return "port must name a serial line, like /dev/ttyUSB0";
  if (std::ranges::count(kBauds, config.baud) == 0)
    return "baud must be 9600, 19200, 38400 or 500000";
  if (std::ranges::count(kRanges, config.range_m) == 0) return "range_m must be 8, 16, 32 or 80";
  if (std::ranges::count(kResolutions, config.resolution_deg) == 0)
    return "resolution_deg must be 1, 0.5 or 0.25";
  return {};
}

}  // namespace voxlist::scanner
