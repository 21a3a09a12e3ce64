#include "services/voxlist/report/measured/scanner_recording.h"

#include <cmath>

#include "voxlist/calibration/parameters.h"
#include "voxlist/scanner/mirror/mirror_clock.h"
#include "voxlist/scanner/sweep/beam_geometry.h"
#include "voxlist/scanner/sweep/cloud_assembler.h"
#include "voxlist/scanner/sweep/mirror_motion.h"

namespace voxlist::desk {
namespace {

using Eigen::Vector3d;

constexpr double kDuration_s = 60.0;
constexpr double kClouds_s = 8.0;
constexpr std::size_t kTurnLines = 150;
constexpr std::uint64_t kSeed = 8;

simulation::Building room_of_figure_8() {
  const Vector3d half = kRoomHalf_m, middle(0.0, 0.0, half.z());
  constexpr double kWall_m = 0.1;
  std::vector<simulation::Box> walls;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Vector3d centre = middle, size = half.array() + kWall_m;
      centre[axis] += side * (half[axis] + kWall_m / 2.0);
      size[axis] = kWall_m / 2.0;
      walls.push_back({centre, size, 0.0});
    }
  return {simulation::BoxTree(std::move(walls)), {}, {}};
}

scanner::MirrorClock clock_of(const simulation::MirrorScannerConfig& config) {
  scanner::MirrorClockConfig clock;
  for (const simulation::ArmRod& arm : config.mirror.arms)
    clock.arms.push_back({arm.angle_deg * kRadPerDeg, arm.beam_first_deg * kRadPerDeg,
                          arm.beam_last_deg * kRadPerDeg});
  return scanner::MirrorClock(clock);
}

}  // namespace

ScannerRecording::ScannerRecording(const simulation::MirrorScannerConfig& config)
    : config_(config),
      world_(room_of_figure_8()),
      stands_(1.0, {kStand}),
      scanner_(world_, stands_, config_, kSeed) {
  scanner::MirrorClock clock = clock_of(config_);
  std::int64_t edge = 0;
  const auto lines = static_cast<std::int64_t>(kDuration_s * config_.turns_per_second);
  for (std::int64_t i = 0; i < lines; ++i) {
    const double t_s = static_cast<double>(i) / config_.turns_per_second;
    for (; scanner_.motor().edge_s(edge) <= t_s; ++edge)
      clock.add_edge(std::llround(scanner_.motor().edge_s(edge) * 1e6));
    log_.lines.push_back(scanner_.measure(std::llround(t_s * 1e6)));
    log_.mirror.push_back(clock.add_line(log_.lines.back()));
  }
}

std::vector<Cloud> ScannerRecording::clouds(const scanner::CloudAssemblerConfig& config) const {
  scanner::CloudAssembler assembler(config);
  std::vector<Cloud> clouds;
  const auto take = [&](scanner::Assembly assembly) {
    for (Cloud& cloud : assembly.clouds) clouds.push_back(std::move(cloud));
  };
  for (std::size_t i = 0; i < log_.lines.size(); ++i) {
    if (static_cast<double>(log_.lines[i].utime_us) < (kDuration_s - kClouds_s) * 1e6) continue;
    take(assembler.add_mirror(log_.mirror[i]));
    take(assembler.add_line(log_.lines[i]));
  }
  return clouds;
}

std::vector<ScannerRecording::SeenPoint> ScannerRecording::noise_free_turn(
    const scanner::CloudAssemblerConfig& config) const {
  const scanner::BeamGeometry geometry(config);
  scanner::MirrorMotion motion(config.staircase,
                               std::llround(config.mirror_extrapolation_ms * 1e3));
  std::vector<SeenPoint> points;
  for (std::size_t i = log_.lines.size() - kTurnLines; i < log_.lines.size(); ++i) {
    motion.add(log_.mirror[i]);
    const LaserLine& line = log_.lines[i];
    for (std::size_t beam = 0; beam < line.ranges_m.size(); ++beam) {
      const double delay_us = beam_delay_us(line, beam);
      const double t_s = (static_cast<double>(line.utime_us) + delay_us) * 1e-6;
      const simulation::SimulatedBeam is =
          scanner_.trace(t_s - config_.latency_s, line.angle_rad(beam));
      const scanner::MirrorAt mirror =
          motion.at(line.utime_us + std::llround(delay_us - config.geometry.latency_ms * 1e3));
      scanner::BeamHit hit;
      if (is.met == simulation::SimulatedBeam::Met::kWorld &&
          mirror.known == scanner::MirrorAt::Known::kYes &&
          geometry.follow(mirror.psi_rad, line.angle_rad(beam), static_cast<float>(is.range_m),
                          hit) == scanner::BeamFate::kPoint)
        points.push_back({is.point_base(is.range_m), hit.point});
    }
  }
  return points;
}

}  // namespace voxlist::desk
