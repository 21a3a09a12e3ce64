#pragma once

#include <cstddef>
#include <vector>

#include "voxlist/scanner/arms/passage_fit.h"

namespace voxlist::scanner {

/// Holds a reference angle (the motor's clock, or even time) against the arms' passages: whether
/// each passage is where the ones before it say, and by how much the mirror slipped when not.
///
/// Passages come as reference minus the arm's own angle, of any turn.
class MirrorTrack {
 public:
  enum class Verdict {
    kFirst,    ///< nothing to compare it with, or nothing that it could be compared with fits it
    kFits,     ///< where it was expected
    kOff,      ///< not there: a wild one, or the first after a slip
    kSlipped,  ///< not there, and earlier ones agree by how much: slip_rad() was put right
  };

  /// `step_rad`: the mirror slips by whole ones; 0: by anything.
  MirrorTrack(std::size_t arms, double step_rad, const PassageFit::Options& options);

  Verdict add(PassageAngles passage);

  /// Forgets all passages, not the rate.
  void clear();

  /// The mirror may have slipped by any angle: the next passage that is off starts anew.
  void doubt() { doubtful_ = true; }

  /// Two passages or more fit each other, and no doubt.
  bool locked() const { return fit_.passages() >= 2 && !doubtful_; }

  double slip_rad() const { return slip_rad_; }
  std::size_t passages() const { return fit_.passages(); }

  /// Mirror angle minus reference, at a time (seconds as the passages').
  double offset_rad(double time_s) const { return -fit_.middle_rad(time_s); }

  /// The mirror's rate minus the reference's.
  double rate_radps() const { return -fit_.rate_radps(); }

  double residual_rad() const { return fit_.residual_rad(); }

 private:
  PassageAngles::Span needed_turn(const PassageAngles& passage) const;
  Verdict settle_slip();
  Verdict start_with(const PassageAngles& passage);

  double step_rad_;
  PassageFit::Options options_;
  PassageFit fit_;
  std::vector<PassageAngles> off_;
  int fits_since_off_ = 0;
  double slip_rad_ = 0.0;
  bool doubtful_ = false;
};

}  // namespace voxlist::scanner
