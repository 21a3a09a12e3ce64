#pragma once

#include <optional>

#include "voxlist/geometry/pose.h"

namespace voxlist::mapping {

class Piece;

/// Where one piece lies in another one of several, by scans that fit both: what the likeliest one
/// said that was not sure by itself is kept for the next.
class PieceJoint {
 public:
  /// A scan was found in both, at `T_there_base` and `T_here_base`, with this probability. Whether
  /// it says surely where the pieces lie to each other, by itself or with the one that is kept.
  /// Neighbours err together, so the less sure of two counts half. `there`: which of the others.
  bool add(const Piece* there, const Pose2& T_there_base, const Pose2& T_here_base,
           double confidence);

  /// Forgets what is kept.
  void clear() { kept_.reset(); }

  /// The other piece is no more.
  void forget(const Piece* there) {
    if (kept_ && kept_->there == there) kept_.reset();
  }

 private:
  struct Kept {
    const Piece* there;
    Pose2 T_there_here;
    double log_odds;
  };

  bool agrees(const Piece* there, const Pose2& T_there_base, const Pose2& T_here_base) const;

  std::optional<Kept> kept_;
};

/// Whether two poses are the same place, found twice.
bool is_same_place(const Pose2& a, const Pose2& b);

/// Whether one scan alone says surely where it was taken, when it was looked for everywhere.
bool is_sure_alone(double confidence);

/// So much (m) may a pose be off in the worst direction, as a standard deviation, to tell a place.
inline constexpr double kSamePlace_m = 0.3;

}  // namespace voxlist::mapping
