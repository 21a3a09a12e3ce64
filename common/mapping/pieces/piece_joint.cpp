#include "voxlist/mapping/pieces/piece_joint.h"

#include <algorithm>

#include "voxlist/geometry/elementary.h"
#include "voxlist/matching/localisation/reach_match.h"

namespace voxlist::mapping {
namespace {

// One scan alone is sure from these odds (their logarithm) on. In simulated rooms of 8 m range,
// each looked for at some twenty places, wrong ones came to 7.3.
constexpr double kSureAlone = 10.0;
// Two searches found the same place if they differ by no more than this and kSamePlace_m.
constexpr double kSame_rad = 0.03;

double log_odds(double probability) {
  constexpr double kNearlyOne = 1.0 - 1e-9;
  return elementary::log(probability) - elementary::log(1.0 - std::min(probability, kNearlyOne));
}

}  // namespace

bool is_same_place(const Pose2& a, const Pose2& b) {
  return distance_m(a, b) < kSamePlace_m && turn_rad(a, b) < kSame_rad;
}

bool is_sure_alone(double confidence) { return log_odds(confidence) >= kSureAlone; }

bool PieceJoint::add(const Piece* there, const Pose2& T_there_base, const Pose2& T_here_base,
                     double confidence) {
  if (is_sure_alone(confidence)) return true;
  const double odds = log_odds(confidence);
  if (agrees(there, T_there_base, T_here_base) && std::min(odds, kept_->log_odds) > 0.0 &&
      std::max(odds, kept_->log_odds) + 0.5 * std::min(odds, kept_->log_odds) >=
          log_odds(matching::kSureInReach))
    return true;
  if (!kept_ || odds >= kept_->log_odds)
    kept_ = {there, T_there_base * T_here_base.inverse(), odds};
  return false;
}

bool PieceJoint::agrees(const Piece* there, const Pose2& T_there_base,
                        const Pose2& T_here_base) const {
  return kept_ && kept_->there == there &&
         is_same_place(kept_->T_there_here * T_here_base, T_there_base);
}

}  // namespace voxlist::mapping
