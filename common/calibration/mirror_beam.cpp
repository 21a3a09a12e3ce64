#include "voxlist/calibration/mirror_beam.h"

#include <algorithm>
#include <cmath>

#include "voxlist/scanner/sweep/beam_geometry.h"
#include "voxlist/scanner/sweep/mirror_motion.h"

namespace voxlist::calibration {
namespace {

// The states of a log, taken as time goes on.
class MirrorLog {
 public:
  MirrorLog(const std::vector<MirrorState>& states, const scanner::CloudAssemblerConfig& scanner)
      : states_(states),
        reach_us_(std::llround(scanner.mirror_extrapolation_ms * 1e3)),
        motion_(scanner.staircase, reach_us_) {}

  // Takes times in ascending order: states that have been passed are not looked at again.
  scanner::MirrorAt at(std::int64_t utime_us) {
    for (; next_ < states_.size() && states_[next_].utime_us <= utime_us + reach_us_; ++next_) {
      motion_.add(states_[next_]);
    }
    return motion_.at(utime_us);
  }

 private:
  const std::vector<MirrorState>& states_;
  std::size_t next_ = 0;
  const std::int64_t reach_us_;
  scanner::MirrorMotion motion_;
};

// An even choice that follows neither the lines' nor the sweeps' rhythm: Fibonacci hashing.
void thin(std::vector<MirrorBeam>& beams, std::size_t most) {
  if (beams.size() <= most) return;
  const double share = static_cast<double>(most) / static_cast<double>(beams.size());
  std::uint64_t index = 0;
  std::erase_if(beams, [&](const MirrorBeam&) {
    const std::uint64_t hash = ++index * 0x9E3779B97F4A7C15ULL;
    return static_cast<double>(hash >> 11) * 0x1p-53 >= share;
  });
}

}  // namespace

BeamSet gather_beams(const std::vector<LaserLine>& lines, const std::vector<MirrorState>& mirror,
                     const scanner::CloudAssemblerConfig& scanner, std::size_t max_beams) {
  const double latency_s = parameters_of(scanner.geometry)[kLatency];
  const scanner::BeamGeometry geometry(scanner);
  MirrorLog log(mirror, scanner);
  BeamSet set;
  for (const LaserLine& line : lines) {
    bool known = true;
    for (std::size_t i = 0; i < line.ranges_m.size(); ++i) {
      const double delay_us = beam_delay_us(line, i) - latency_s * 1e6;
      const scanner::MirrorAt at = log.at(line.utime_us + std::llround(delay_us));
      known = known && at.known == scanner::MirrorAt::Known::kYes;
      if (at.known != scanner::MirrorAt::Known::kYes) continue;
      if (scanner.mirror_sides == 1 && geometry.side(at.psi_rad) == 1) continue;
      scanner::BeamHit hit;
      if (geometry.follow(at.psi_rad, line.angle_rad(i), line.ranges_m[i], hit) !=
          scanner::BeamFate::kPoint)
        continue;
      set.beams.push_back({line.angle_rad(i), line.ranges_m[i],
                           at.psi_rad + at.rate_radps * latency_s, at.rate_radps});
    }
    ++(known ? set.lines : set.lines_without_mirror);
  }
  thin(set.beams, max_beams);
  return set;
}

}  // namespace voxlist::calibration
