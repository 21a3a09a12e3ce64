#include "tests/scanner/mirror/synthetic_mirror.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "voxlist/geometry/pose.h"

namespace voxlist::scanner {

double SyntheticMirror::angle_rad(double time_s) const {
  const double turned_s = time_s - (standing_s ? standing_s(time_s) : 0.0);
  double steps = turned_s / clock_period_s();
  if (staircase) steps = std::floor(steps + 1e-9);
  return start_rad + direction * steps * 2.0 * std::numbers::pi / steps_per_revolution;
}

double SyntheticMirror::range_m(double time_s, double beam_rad) {
  const double psi = angle_rad(time_s);
  const double h = 0.1, s = std::sin(beam_rad);
  for (const Arm& arm : arms) {
    const bool on = beam_rad > arm.first_deg * kDeg - 1e-9 && beam_rad < arm.last_deg * kDeg + 1e-9;
    const double off = wrap_angle(psi - arm.angle_deg * kDeg);
    if (arm.there && on && std::abs(off) < half_width_deg * kDeg) return 0.038 / s;
  }
  const bool on_mirror = beam_rad > 22.0 * kDeg && beam_rad < 158.0 * kDeg;
  const double edge = std::abs(wrap_angle(2.0 * psi)) / 2.0;
  if (on_mirror && edge < 2.5 * kDeg) return 0.05 / s;
  if (!room) return 3.0;

  // A room of 7 x 5 x 2.6 m with a pillar's corner; the mirror 0.7 m above the floor.
  const double yaw = turn_degps * kDeg * time_s;
  const double x0 = 0.8 + std::fmod(speed_mps * time_s, 2.0), y0 = 0.4, z0 = 0.7;
  double dx = -s * std::sin(2.0 * psi), dy = std::cos(beam_rad), dz = s * std::cos(2.0 * psi);
  if (!on_mirror) dx = 0.0, dz = s;
  const double wx = std::cos(yaw) * dx - std::sin(yaw) * dy;
  const double wy = std::sin(yaw) * dx + std::cos(yaw) * dy;
  const auto wall = [](double p, double d, double low, double high) {
    if (std::abs(d) < 1e-12) return std::numeric_limits<double>::infinity();
    return ((d > 0.0 ? high : low) - p) / d;
  };
  // The robot's body below.
  if (on_mirror && dz < -0.8) return h / s + 0.25 / -dz;
  double r = std::min(wall(x0, wx, -3.5, 3.5), wall(y0, wy, -2.5, 2.5));
  const double vertical = wall(z0, dz, 0.0, 2.6);
  if (!(sky && dz > 0.0)) r = std::min(r, vertical);
  if (sky && dz > 0.0 && dz * r > 0.3) return std::numeric_limits<double>::infinity();
  if (r + h / s > 8.183) return std::numeric_limits<double>::infinity();
  return h / s + r;
}

LaserLine SyntheticMirror::line(double time_s) {
  std::normal_distribution<double> noise(0.0, 0.005);
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  LaserLine line;
  for (std::size_t i = 0; i < 181; ++i) {
    const double beam_rad = static_cast<double>(i) * kDeg;
    const double beam_s = time_s + static_cast<double>(i) / 360.0 / line_hz;
    double range = std::abs(range_m(beam_s, beam_rad) + noise(random));
    if (chance(random) < spurious) range = 0.05;
    if (chance(random) < dazzled) range = std::numeric_limits<double>::quiet_NaN();
    line.ranges_m.push_back(static_cast<float>(range));
  }
  return line;
}

MirrorClockConfig MirrorRun::usual_config() {
  MirrorClockConfig config;
  config.arms = {{90.0 * kDeg, 25.0 * kDeg, 60.0 * kDeg},
                 {265.0 * kDeg, 120.0 * kDeg, 155.0 * kDeg}};
  return config;
}

void MirrorRun::until(double end_s, const std::function<void(double, const MirrorState&)>& see) {
  std::normal_distribution<double> gauss(0.0, 1.0);
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  const auto utime = [this](double time_s, double jitter_us) {
    return origin_us + std::llround(time_s * 1e6 + jitter_us);
  };
  for (; line_s < end_s; line_s += 1.0 / mirror.line_hz) {
    // Edges come with 20 ms of delay, lines with 10.
    for (;; ++edge) {
      const double edge_s = static_cast<double>(edge) * mirror.clock_period_s();
      if (edge_s + 0.02 > line_s + 0.01) break;
      if (!clock_runs || chance(mirror.random) < mirror.lost_edges) continue;
      clock.add_edge(utime(edge_s, mirror.edge_jitter_us * gauss(mirror.random)));
      if (chance(mirror.random) < mirror.doubled_edges)
        clock.add_edge(utime(edge_s, 300.0 + mirror.edge_jitter_us * gauss(mirror.random)));
    }
    LaserLine line = mirror.line(line_s);
    const double stamp_off_us = mirror.stamp_off_us ? mirror.stamp_off_us(line_s) : 0.0;
    line.utime_us = utime(line_s, stamp_off_us + mirror.stamp_jitter_us * gauss(mirror.random));
    if (chance(mirror.random) < mirror.lost_lines) continue;
    if (mirror.line_lost && mirror.line_lost(line_s)) continue;
    const MirrorState state = clock.add_line(line);
    if (see) see(line_s, state);
  }
}

double MirrorRun::error_rad(double time_s, const MirrorState& state) const {
  const double since_s = time_s - static_cast<double>(state.utime_us - origin_us) * 1e-6;
  double turned = state.rate_radps * since_s;
  if (config.staircase && state.step_rad > 0.0) {
    // The middle of the line: where a step is just due, either stop is right.
    turned = std::copysign(state.step_rad, state.rate_radps) *
             std::floor(std::abs(state.rate_radps) * since_s / state.step_rad + 1e-3);
  }
  return wrap_angle(state.angle_rad + turned - mirror.angle_rad(time_s));
}

}  // namespace voxlist::scanner
