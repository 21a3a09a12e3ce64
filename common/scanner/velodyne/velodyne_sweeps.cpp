#include "voxlist/scanner/velodyne/velodyne_sweeps.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace voxlist::scanner {
namespace {

constexpr int kTurn_cdeg = 36'000, kHalfTurn_cdeg = kTurn_cdeg / 2;

// A pause longer than this (us) is no gap between packets: the recording was stopped, or the
// laser's clock was set. Time goes on with the arrivals then.
constexpr std::int64_t kPause_us = 10'000'000;

// A laser that takes longer for a turn (s) stands still: what it sees is cut, so that it has an
// end.
constexpr float kLongest_s = 0.5F;

int from_behind(int azimuth_cdeg) { return (azimuth_cdeg + kHalfTurn_cdeg) % kTurn_cdeg; }

// The time that passed between two of the laser's times, which begin anew each hour: the shorter
// way round, so that it is negative where packets came in the wrong order.
std::int64_t step_us(std::uint32_t from_us, std::uint32_t to_us) {
  const std::int64_t step = std::int64_t{to_us} - std::int64_t{from_us};
  if (step < -kVelodyneHour_us / 2) return step + kVelodyneHour_us;
  return step > kVelodyneHour_us / 2 ? step - kVelodyneHour_us : step;
}

}  // namespace

std::optional<VelodyneSweep> VelodyneSweeps::add(const VelodynePacket& packet,
                                                 std::int64_t arrival_us) {
  const std::int64_t step = stamp_us_ ? step_us(*stamp_us_, packet.stamp_us) : 0;
  if (stamp_us_ && step <= 0 && step > -kPause_us) {
    ++late_;
    return std::nullopt;
  }
  if (!stamp_us_ || std::abs(step) > kPause_us) {
    utime_us_ = arrival_us;
  } else {
    utime_us_ += step;
    missing_ += std::max<std::int64_t>(0, std::llround(static_cast<double>(step) / length_us_) - 1);
  }
  stamp_us_ = packet.stamp_us;
  length_us_ = packet.length_us;
  drift_us_ = utime_us_ - arrival_us;
  std::optional<VelodyneSweep> whole;
  for (const VelodyneBlock& block : packet.blocks) {
    if (ends_before(block)) whole = finish();
    azimuth_cdeg_ = from_behind(block.azimuth_cdeg);
    take(block, utime_us_);
  }
  return whole;
}

bool VelodyneSweeps::ends_before(const VelodyneBlock& block) const {
  if (!azimuth_cdeg_) return false;
  const bool is_round = from_behind(block.azimuth_cdeg) < *azimuth_cdeg_ - kHalfTurn_cdeg;
  return is_round || (!sweep_.after_s.empty() && sweep_.after_s.back() > kLongest_s);
}

std::optional<VelodyneSweep> VelodyneSweeps::finish() {
  VelodyneSweep sweep = std::exchange(sweep_, {});
  return sweep.points.empty() ? std::nullopt : std::optional(std::move(sweep));
}

void VelodyneSweeps::take(const VelodyneBlock& block, std::int64_t packet_us) {
  for (const VelodyneReturn& back : block.returns) {
    if (sweep_.points.empty())
      sweep_.utime_us = packet_us + static_cast<std::int64_t>(back.after_us);
    sweep_.points.push_back(back.point);
    const double from_sweep_us = static_cast<double>(packet_us - sweep_.utime_us) + back.after_us;
    sweep_.after_s.push_back(static_cast<float>(from_sweep_us * 1e-6));
    sweep_.rings.push_back(back.ring);
    sweep_.intensities.push_back(back.intensity);
  }
}

}  // namespace voxlist::scanner
