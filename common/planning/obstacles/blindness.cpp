#include "voxlist/planning/obstacles/blindness.h"

#include <algorithm>
#include <numeric>

namespace voxlist::planning {
namespace {

// No cloud for three times as long as between the last two, but for so long at least and at most
// (us): slices come each 67 ms and a busy machine pauses; a sweep takes 1 s.
constexpr std::int64_t kShortest_us = 300'000, kLongest_us = 3'000'000;

// MIRROR that is older says nothing of now (us).
constexpr std::int64_t kMirrorAge_us = 1'000'000;

// Points of a whole sweep are counted (us): slices that look up into the open have none.
constexpr std::int64_t kSweep_us = 1'200'000, kWhole_us = 1'000'000;

// The lens is covered with fewer points than these, or than this share of the most there were. A
// robot that leaves a room has a quarter of them left: the floor.
constexpr std::size_t kFewest = 50;
constexpr double kShare = 0.05;

}  // namespace

void Blindness::take(const Cloud& cloud_base, std::int64_t now_us) {
  cloud_us_ = now_us;
  if (!seen_.empty()) {
    const std::int64_t step_us = cloud_base.utime_us - seen_.back().utime_us;
    if (step_us < 0) seen_.clear();
    period_us_ = std::max<std::int64_t>(0, step_us);
  }
  count_points(cloud_base);
}

void Blindness::take(const MirrorState& state, std::int64_t now_us) {
  mirror_ = state;
  mirror_us_ = now_us;
}

void Blindness::count_points(const Cloud& cloud) {
  std::size_t points = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (static_cast<double>((cloud.points[i] - cloud.origin(i)).norm()) > min_range_m_) ++points;
  seen_.push_back({cloud.utime_us, points});
  while (cloud.utime_us - seen_.front().utime_us > kSweep_us) seen_.pop_front();
  most_points_ = std::max(most_points_, recent_points().value_or(0));
}

// Those of the last sweep; nothing before there was a whole one.
std::optional<std::size_t> Blindness::recent_points() const {
  if (seen_.empty()) return std::nullopt;
  const bool is_whole = seen_.back().utime_us - seen_.front().utime_us >= kWhole_us - period_us_;
  if (!is_whole) return std::nullopt;
  return std::accumulate(seen_.begin(), seen_.end(), std::size_t{0},
                         [](std::size_t sum, const Seen& seen) { return sum + seen.points; });
}

std::int64_t Blindness::silence_us() const {
  return period_us_ == 0 ? kLongest_us : std::clamp(3 * period_us_, kShortest_us, kLongest_us);
}

std::string Blindness::why(std::int64_t now_us) const {
  if (mirror_us_ && now_us - *mirror_us_ < kMirrorAge_us && !mirror_.angle_known)
    return "the mirror's angle is not known: " + mirror_.reason;
  if (!cloud_us_) return "no CLOUD_SLICE and no CLOUD yet: is the scanner running?";
  if (now_us - *cloud_us_ > silence_us())
    return "no CLOUD_SLICE and no CLOUD any more: is the scanner running?";
  const auto points = recent_points();
  if (points && (*points < kFewest ||
                 static_cast<double>(*points) < kShare * static_cast<double>(most_points_)))
    return "hardly any beam comes back: is the lens covered?";
  return {};
}

}  // namespace voxlist::planning
