#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/geometry/laser_line.h"
#include "voxlist/scanner/arms/line_motion.h"

namespace voxlist::scanner {

/// Holds whether the mirror stands: lines are still for longer than a turning mirror leaves them
/// (StallWatch), or no arm comes and lines do not change either. Lines that are lost say nothing.
class MirrorStall {
 public:
  /// Takes the next line, of a mirror that turns at about this rate, if it is known. True when the
  /// mirror has now come to stand.
  bool add(const LaserLine& line, std::optional<double> rate_radps, bool arms_silent);

  /// An arm passed where it was expected: the mirror turned until now.
  void turned();

  /// When it came to stand; nothing while it turns.
  std::optional<std::int64_t> since_us() const { return since_us_; }

  /// For how long lines have been still, microseconds.
  double still_us() const { return watch_.still_us(); }

  void reset() { *this = {}; }

 private:
  LineMotion motion_;
  StallWatch watch_;
  std::optional<std::int64_t> since_us_;
};

}  // namespace voxlist::scanner
