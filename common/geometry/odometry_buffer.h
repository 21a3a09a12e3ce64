#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "voxlist/geometry/cloud.h"
#include "voxlist/geometry/tilt.h"

namespace voxlist {

/// The newest odometry, to be asked where it stood at a time. Live and from a log it gives the same
/// answers, as long as odometry comes before what is asked about.
class OdometryBuffer {
 public:
  /// Odometry older than this says nothing of now: the wheels' computer is dead (us).
  static constexpr std::int64_t kMaxAge_us = 1'000'000;

  /// Poses that are kept: ten seconds of the fastest odometry.
  static constexpr std::size_t kCapacity = 1000;

  /// Takes T_odom_base, and what it leaves out. Poses may come a little out of order; one that is
  /// more than kMaxAge_us older than the newest means that time started anew, and all before it is
  /// forgotten.
  void add(const StampedPose2& T_odom_base, const Tilt& tilt = {});

  /// The latest pose that is not after the time, as it was measured. Nothing when there is none, or
  /// when it is older than kMaxAge_us then.
  std::optional<Pose2> at(std::int64_t utime_us) const;

  /// Roll and pitch of that pose; nothing also where both are exactly 0: this odometry does not
  /// measure them.
  std::optional<Tilt> tilt_at(std::int64_t utime_us) const;

  /// The pose at the time itself, for what moves between two measurements: on the arc between its
  /// neighbours, or for at most `max_extrapolation_us` after the newest moved on at the last
  /// velocity. Nothing before the oldest, later than that, without two poses to tell a velocity,
  /// or where neighbours are more than kMaxAge_us apart.
  std::optional<Pose2> estimate(std::int64_t utime_us, std::int64_t max_extrapolation_us) const;

  /// Time of the newest pose; nothing when there is none.
  std::optional<std::int64_t> newest_utime_us() const;

 private:
  struct Entry : StampedPose2 {
    Tilt tilt;
  };

  const Entry* latest(std::int64_t utime_us) const;
  std::optional<Pose2> extrapolated(std::int64_t utime_us) const;

  std::deque<Entry> poses_;  // by time
};

}  // namespace voxlist
