#pragma once

#include <cstdint>
#include <optional>

#include "voxlist/scanner/arms/arm_detector.h"
#include "voxlist/scanner/arms/arm_rate.h"
#include "voxlist/scanner/mirror/mirror_clock_config.h"
#include "voxlist/scanner/mirror/mirror_track.h"

namespace voxlist::scanner {

/// Where the mirror is by its arms alone: it is taken to turn evenly, at a rate and in a direction
/// that its arms' passages tell.
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

  /// Passages fit each other; what follows needs it.
  bool locked() const { return track_ && track_->locked(); }

  /// So many passages did that their rate may be held against another.
  bool rate_is_sure() const;

  /// The angle at a time (of any turn), and its standard deviation.
  double angle_rad(std::int64_t utime_us) const;
  double residual_rad() const;

  /// With sign.
  double rate_radps() const { return even_rate_radps_ + track_->rate_radps(); }

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
  double even_rate_radps_ = 0.0;  // of even time as a reference that turns
  std::int64_t even_origin_us_ = 0;
  std::optional<MirrorTrack> track_;
  std::int64_t origin_us_ = 0;
};

}  // namespace voxlist::scanner
