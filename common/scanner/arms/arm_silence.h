#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/scanner/arms/arm_detector.h"

namespace voxlist::scanner {

/// Notices that arms no longer pass: both, or one of them.
class ArmSilence {
 public:
  explicit ArmSilence(const std::vector<BlockingArm>& arms);

  /// Forgets all passages; an arm that never passes is missed from here on.
  void start(std::int64_t utime_us);

  void passed(const ArmPassage& passage);

  /// A line came, at its own time: nobody looked for arms in a hole between lines.
  void looked(std::int64_t utime_us);

  /// Seconds since the last passage; nothing before the first.
  std::optional<double> silent_s(std::int64_t now_us) const;

  /// No arm for clearly longer than from one arm to the next, at this rate of the mirror. False
  /// before the first passage.
  bool silent(std::int64_t now_us, double rate_radps) const;

  /// Silent, and lines came without a hole for all of that time: no passage can have been missed.
  bool silent_in_view(std::int64_t now_us, double rate_radps) const;

  /// The first arm, if any, that has not passed for more than two turns at this rate. None before
  /// the first passage.
  std::optional<std::size_t> missing(std::int64_t now_us, double rate_radps) const;

 private:
  double silence_s(std::int64_t now_us, double rate_radps) const;

  double widest_gap_rad_;                   // from one arm to the next
  std::vector<std::int64_t> last_seen_us_;  // of each arm; or the start
  std::optional<std::int64_t> any_seen_us_;
  std::int64_t looking_since_us_ = 0;  // without a hole
  std::int64_t last_look_us_ = 0;
};

}  // namespace voxlist::scanner
