#include "voxlist/scanner/sweep/cloud_assembler.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "voxlist/geometry/angle.h"

namespace voxlist::scanner {
namespace {

// A sweep with more points is thrown away. One of 75 lines has 9,825 beams on the mirror, so this
// is a mirror that needs 100 s or more for half a turn; a cloud of a million points has 24 MB.
constexpr std::size_t kMaxSweepPoints = 1'000'000;

std::int64_t to_us(double ms) { return std::llround(ms * 1e3); }

std::int64_t beam_utime_us(const LaserLine& line, std::size_t beam) {
  return line.utime_us + std::llround(beam_delay_us(line, beam));
}

const CloudAssemblerConfig& checked(const CloudAssemblerConfig& config) {
  if (config.mirror_sides == 1 && std::fmod(config.sweep_boundary_deg, 360.0) != 0.0)
    throw std::invalid_argument(
        "sweep_boundary_deg must be 0 with mirror_sides = 1: else each sweep is cut in two");
  return config;
}

}  // namespace

CloudAssembler::CloudAssembler(const CloudAssemblerConfig& config)
    : config_(checked(config)),
      odometry_reach_us_(to_us(config.odometry_extrapolation_ms)),
      beams_(config),
      motion_(config.staircase, to_us(config.mirror_extrapolation_ms)),
      divider_(config.sweep_boundary_deg * kRadPerDeg, 1.0 / config.lines_per_s),
      sweep_{{config.use_odometry ? &odometry_ : nullptr, odometry_reach_us_}},
      slice_{{config.use_odometry ? &odometry_ : nullptr, odometry_reach_us_}} {}

Assembly CloudAssembler::add_line(LaserLine line) {
  Assembly out;
  if (line.ranges_m.empty()) return out;
  line.utime_us -= to_us(config_.geometry.latency_ms);
  note_time(line, out);
  if (newest_us_ && line.utime_us <= *newest_us_) {
    ++out.counts[LineFate::kOutOfOrder];
    return out;
  }
  newest_us_ = line.utime_us;
  waiting_.push_back(std::move(line));
  if (waiting_.size() > static_cast<std::size_t>(config_.max_waiting_lines)) {
    waiting_.pop_front();
    ++out.counts[LineFate::kTooManyWaiting];
  }
  advance(out);
  return out;
}

Assembly CloudAssembler::add_mirror(const MirrorState& state) {
  Assembly out;
  motion_.add(state);
  advance(out);
  return out;
}

Assembly CloudAssembler::add_odometry(const StampedPose2& T_odom_base) {
  Assembly out;
  odometry_.add(T_odom_base);
  sweep_.points.settle();
  advance(out);
  return out;
}

void CloudAssembler::note_time(const LaserLine& line, Assembly& out) {
  if (!newest_us_) return;
  const std::int64_t step_us = line.utime_us - *newest_us_;
  if (step_us < -kTimeStartsAnew_us) {
    ++out.counts[LineFate::kTimeStartedAnew];
    newest_us_.reset();
    waiting_.clear();
    sweep_.clear();
    slice_.clear();
    divider_.forget();
  } else if (const auto steps =
                 std::llround(static_cast<double>(step_us) * 1e-6 * config_.lines_per_s);
             steps > 1) {
    out.counts[LineFate::kMissing] += steps - 1;
  }
}

void CloudAssembler::advance(Assembly& out) {
  while (!waiting_.empty()) {
    const LaserLine& line = waiting_.front();
    const std::optional<LineFate> lack = look_up(line);
    const bool may_come = lack == LineFate::kNoMirrorYet || lack == LineFate::kNoOdometry;
    if (may_come && !is_overdue(line)) return;
    if (lack)
      drop(*lack, out);
    else
      assemble(line, out);
    waiting_.pop_front();
  }
}

std::optional<LineFate> CloudAssembler::look_up(const LaserLine& line) {
  mirror_.clear();
  for (std::size_t i = 0; i < line.ranges_m.size(); ++i) {
    mirror_.push_back(motion_.at(beam_utime_us(line, i)));
    switch (mirror_.back().known) {
      case MirrorAt::Known::kYes:
        break;
      case MirrorAt::Known::kNotYet:
        return LineFate::kNoMirrorYet;
      case MirrorAt::Known::kLost:
        return LineFate::kMirrorLost;
      case MirrorAt::Known::kNever:
        return LineFate::kMirrorUnknown;
    }
  }
  if (!config_.use_odometry) return std::nullopt;
  const auto is_known = [this](std::int64_t utime_us) {
    return odometry_.estimate(utime_us, odometry_reach_us_).has_value();
  };
  if (is_known(line.utime_us) && is_known(beam_utime_us(line, line.ranges_m.size() - 1)))
    return std::nullopt;
  return LineFate::kNoOdometry;
}

bool CloudAssembler::is_overdue(const LaserLine& line) const {
  return *newest_us_ - line.utime_us > to_us(config_.max_wait_ms);
}

void CloudAssembler::drop(LineFate why, Assembly& out) {
  ++out.counts[why];
  if (why == LineFate::kMirrorLost) abandon_sweep(SweepLoss::kMirrorLost, out);
}

void CloudAssembler::assemble(const LaserLine& line, Assembly& out) {
  const MirrorAt& first = mirror_.front();
  const SweepDivider::Place place =
      divider_.next(beams_.phi_rad(first.psi_rad, 0), 2.0 * first.rate_radps);
  if (place.starts_sweep) end_sweep(out);
  sweep_.whole_lines = place.sweep_lines;
  if (config_.mirror_sides == 1 && beams_.side(mirror_[mirror_.size() / 2].psi_rad) == 1)
    ++out.counts[LineFate::kDeadSide];
  else
    place_beams(line, out);
  if (slice_.lines >= config_.lines_per_slice) end_slice(out);
  if (place.ends_sweep) end_sweep(out);
}

void CloudAssembler::place_beams(const LaserLine& line, Assembly& out) {
  const double period_us = 1e6 / config_.lines_per_s;
  if (slice_.lines > 0 && static_cast<double>(line.utime_us - slice_.end_us) > 1.5 * period_us)
    end_slice(out);  // a slice has no hole
  for (std::size_t i = 0; i < line.ranges_m.size(); ++i) {
    BeamHit hit;
    const BeamFate fate =
        beams_.follow(mirror_[i].psi_rad, line.angle_rad(i), line.ranges_m[i], hit);
    ++out.counts[fate];
    if (fate != BeamFate::kPoint) continue;
    sweep_.points.add(beam_utime_us(line, i), hit);
    slice_.points.add(beam_utime_us(line, i), hit);
  }
  for (Part* part : {&sweep_, &slice_}) {
    ++part->lines;
    part->end_us = beam_utime_us(line, line.ranges_m.size() - 1);
    part->points.settle();
  }
  ++out.counts[LineFate::kAssembled];
  if (sweep_.points.size() > kMaxSweepPoints) abandon_sweep(SweepLoss::kTooLong, out);
}

void CloudAssembler::end_slice(Assembly& out) {
  if (slice_.lines > 0)
    if (auto cloud = slice_.points.finish(slice_.end_us)) out.slices.push_back(std::move(*cloud));
  slice_.clear();
}

void CloudAssembler::end_sweep(Assembly& out) {
  end_slice(out);
  if (sweep_.lines > 0) {
    out.line_share = std::min(1.0, sweep_.lines / sweep_.whole_lines);
    if (*out.line_share < config_.min_line_share)
      ++out.counts[SweepLoss::kTooFewLines];
    else if (auto cloud = sweep_.points.finish(sweep_.end_us))
      out.clouds.push_back(std::move(*cloud));
    else
      ++out.counts[SweepLoss::kOdometryLost];
  }
  sweep_.clear();
}

void CloudAssembler::abandon_sweep(SweepLoss why, Assembly& out) {
  if (sweep_.lines > 0) ++out.counts[why];
  sweep_.clear();
  slice_.clear();
  divider_.forget();
}

void CloudAssembler::Part::clear() {
  points.clear();
  lines = 0;
}

}  // namespace voxlist::scanner
