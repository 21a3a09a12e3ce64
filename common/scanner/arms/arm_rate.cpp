#include "voxlist/scanner/arms/arm_rate.h"

#include <cmath>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/pose.h"

namespace voxlist::scanner {
namespace {

// The mirror turns evenly when two turns of one arm differ by no more than this share; a gap
// between arms fits the settings to within this angle (rad, 4.6 deg). Passages are known to two
// lines, 2.4 deg each at half a turn a second.
constexpr double kTurnTolerance = 0.05;
constexpr double kGapTolerance_rad = 0.08;

double seconds(const ArmPassage& from, const ArmPassage& to) {
  return static_cast<double>(to.middle_us() - from.middle_us()) * 1e-6;
}

}  // namespace

ArmRate::ArmRate(std::vector<BlockingArm> arms, double sign)
    : arms_(std::move(arms)), sign_(sign) {}

void ArmRate::reset() {
  passages_.clear();
  strange_gap_rad_.reset();
}

std::optional<double> ArmRate::add(const ArmPassage& passage) {
  passages_.push_back(passage);
  if (passages_.size() > 3) passages_.pop_front();
  if (passages_.size() < 3 || passages_[0].arm != passages_[2].arm) return std::nullopt;
  const double first_s = seconds(passages_[0], passages_[1]);
  const double both_s = seconds(passages_[0], passages_[2]);
  if (first_s <= 0.0 || both_s <= first_s) return std::nullopt;
  if (passages_[0].arm == passages_[1].arm) {
    const bool even = std::abs(2.0 * first_s / both_s - 1.0) < kTurnTolerance;
    return even ? std::optional(sign_ * 2.0 * kTurn_rad / both_s) : std::nullopt;
  }
  // The angle from the first arm to the second, as seen in the wanted direction, against what the
  // settings say for either direction.
  const double seen_rad = first_s / both_s * kTurn_rad;
  const double there_rad = arms_[passages_[1].arm].angle_rad - arms_[passages_[0].arm].angle_rad;
  const double forwards_off = std::abs(wrap_angle(sign_ * there_rad - seen_rad));
  const double backwards_off = std::abs(wrap_angle(-sign_ * there_rad - seen_rad));
  strange_gap_rad_.reset();
  if (std::min(forwards_off, backwards_off) > kGapTolerance_rad) {
    strange_gap_rad_ = passages_[0].arm == 0 ? seen_rad : kTurn_rad - seen_rad;
    return std::nullopt;
  }
  const double sign = forwards_off <= backwards_off ? sign_ : -sign_;
  return sign * kTurn_rad / both_s;
}

}  // namespace voxlist::scanner
