#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/scanner/arms/arm_detector.h"
#include "voxlist/scanner/arms/arm_rate.h"
#include "voxlist/scanner/mirror/mirror_clock_config.h"
#include "voxlist/scanner/mirror/mirror_track.h"

namespace voxlist::scanner {

/// Tells where the mirror is from its arms alone. The mirror is taken to turn evenly, at a rate and
/// in a direction that the arms' passages tell.
class MirrorByArms {
 public:
  explicit MirrorByArms(const MirrorClockConfig& config);

  /// Forgets the passages, not the direction; times of the next ones are near `origin_us`.
  void start(std::int64_t origin_us);

  /// Takes the next passage of an arm: whether it fits the ones before it; nothing when they do not
  /// tell where to expect it.
  std::optional<bool> add(const ArmPassage& passage);

  /// The mirror may have slipped by any angle.
  void doubt();

  /// Whether passages fit each other. Only then may the angle, its residual and the rate be asked
  /// for.
  bool locked() const { return track_ && track_->locked(); }

  /// Whether enough passages did to hold their rate against the clock's.
  bool rate_is_sure() const;

  /// The angle at a time (of any turn), and its standard deviation.
  double angle_rad(std::int64_t utime_us) const;
  double residual_rad() const;

  /// The mirror's rate, negative when psi falls.
  double rate_radps() const;

  /// The sign of the rate, as last seen; before that as configured.
  double direction() const { return direction_; }

  /// See ArmRate.
  std::optional<double> strange_gap_rad() const { return arm_rate_.strange_gap_rad(); }

 private:
  void start_track(double rate_radps);
  MirrorTrack::Verdict follow(const ArmPassage& passage);
  double even_angle_rad(std::int64_t utime_us) const;

  MirrorClockConfig config_;
  double direction_;
  ArmRate arm_rate_;
  double even_rate_radps_ = 0.0;  // at which even time turns, as the track's reference
  std::int64_t even_origin_us_ = 0;
  std::optional<MirrorTrack> track_;
  std::int64_t origin_us_ = 0;
};

}  // namespace voxlist::scanner
