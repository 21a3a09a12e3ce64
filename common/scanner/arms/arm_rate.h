#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "voxlist/scanner/arms/arm_detector.h"

namespace voxlist::scanner {

/// Tells how fast, and in which direction, the mirror turns, from the order and the times of its
/// arms alone: three passages in a row, arm A, arm B, arm A, or three of one arm.
class ArmRate {
 public:
  /// `sign`: the direction that is taken for granted where the arms cannot tell.
  ArmRate(std::vector<BlockingArm> arms, double sign);

  /// Takes the next passage; the rate if now it is known, radians per second with sign.
  std::optional<double> add(const ArmPassage& passage);

  /// The last passages, at most three.
  const std::deque<ArmPassage>& passages() const { return passages_; }

  /// The gaps between the arms agree with the settings in neither direction: the angle from arm 0
  /// to arm 1 as it was seen, in the direction that was taken for granted.
  std::optional<double> strange_gap_rad() const { return strange_gap_rad_; }

  void reset();

 private:
  std::vector<BlockingArm> arms_;
  double sign_;
  std::deque<ArmPassage> passages_;
  std::optional<double> strange_gap_rad_;
};

}  // namespace voxlist::scanner
