#include "voxlist/geometry/odometry_buffer.h"

#include <algorithm>

namespace voxlist {
namespace {

constexpr auto kIsBefore = [](std::int64_t utime_us, const StampedPose2& pose) {
  return utime_us < pose.utime_us;
};

// A velocity is measured over at least this: time stamps that are a little off must not make it
// large.
constexpr std::int64_t kVelocityBase_us = 20'000;

// The pose at a time of a motion that goes evenly from a to b, between them or beyond.
Pose2 on_the_way(const StampedPose2& a, const StampedPose2& b, std::int64_t utime_us) {
  const double share =
      static_cast<double>(utime_us - a.utime_us) / static_cast<double>(b.utime_us - a.utime_us);
  return a.pose * part_of(a.pose.inverse() * b.pose, share);
}

}  // namespace

void OdometryBuffer::add(const StampedPose2& T_odom_base, const Tilt& tilt) {
  if (!poses_.empty() && poses_.back().utime_us - T_odom_base.utime_us > kMaxAge_us) poses_.clear();
  const auto later =
      std::upper_bound(poses_.begin(), poses_.end(), T_odom_base.utime_us, kIsBefore);
  poses_.insert(later, Entry{T_odom_base, tilt});
  if (poses_.size() > kCapacity) poses_.pop_front();
}

const OdometryBuffer::Entry* OdometryBuffer::latest(std::int64_t utime_us) const {
  const auto later = std::upper_bound(poses_.begin(), poses_.end(), utime_us, kIsBefore);
  if (later == poses_.begin()) return nullptr;
  const Entry& latest = *std::prev(later);
  return utime_us - latest.utime_us > kMaxAge_us ? nullptr : &latest;
}

std::optional<Pose2> OdometryBuffer::at(std::int64_t utime_us) const {
  const Entry* entry = latest(utime_us);
  return entry ? std::optional(entry->pose) : std::nullopt;
}

std::optional<Tilt> OdometryBuffer::tilt_at(std::int64_t utime_us) const {
  const Entry* entry = latest(utime_us);
  if (!entry || (entry->tilt.roll_rad == 0.0 && entry->tilt.pitch_rad == 0.0)) return std::nullopt;
  return entry->tilt;
}

std::optional<Pose2> OdometryBuffer::estimate(std::int64_t utime_us,
                                              std::int64_t max_extrapolation_us) const {
  const auto later = std::upper_bound(poses_.begin(), poses_.end(), utime_us, kIsBefore);
  if (later == poses_.begin()) return std::nullopt;
  const StampedPose2& before = *std::prev(later);
  if (before.utime_us == utime_us) return before.pose;
  if (later == poses_.end()) {
    if (utime_us - before.utime_us > max_extrapolation_us) return std::nullopt;
    return extrapolated(utime_us);
  }
  if (later->utime_us - before.utime_us > kMaxAge_us) return std::nullopt;
  return on_the_way(before, *later, utime_us);
}

std::optional<Pose2> OdometryBuffer::extrapolated(std::int64_t utime_us) const {
  const StampedPose2& newest = poses_.back();
  for (auto pose = poses_.rbegin(); pose != poses_.rend(); ++pose) {
    const std::int64_t age_us = newest.utime_us - pose->utime_us;
    if (age_us > kMaxAge_us) break;
    if (age_us >= kVelocityBase_us) return on_the_way(*pose, newest, utime_us);
  }
  return std::nullopt;
}

std::optional<std::int64_t> OdometryBuffer::newest_utime_us() const {
  if (poses_.empty()) return std::nullopt;
  return poses_.back().utime_us;
}

}  // namespace voxlist
