#include "voxlist/simulation/scanner/turning_mirror.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/elementary.h"
#include "voxlist/geometry/pose.h"

namespace voxlist::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Across the axis, at an angle from x towards z.
Vector3d across(double angle_rad) {
  const auto [s, c] = elementary::sine_cosine(angle_rad);
  return {c, 0.0, s};
}

double cotangent(double angle_rad) {
  const auto [s, c] = elementary::sine_cosine(angle_rad);
  return c / s;
}

struct Plane {
  Vector3d outward;
  double offset_m;  // from the axis
};

// Where a ray is inside of something convex, and by which of its planes it came in.
struct Inside {
  double from = -kInfinity, to = kInfinity;
  std::size_t entered = 0;
  bool any() const { return from <= to && from > 0.0; }
};

template <std::size_t N>
Inside inside(const std::array<Plane, N>& planes, const Vector3d& origin,
              const Vector3d& direction) {
  Inside result;
  for (std::size_t i = 0; i < N; ++i) {
    const double away = planes[i].outward.dot(direction);
    const double room = planes[i].offset_m - planes[i].outward.dot(origin);
    if (away == 0.0 && room < 0.0) result.to = -kInfinity;
    if (away > 0.0) result.to = std::min(result.to, room / away);
    if (away < 0.0 && room / away > result.from) {
      result.from = room / away;
      result.entered = i;
    }
  }
  return result;
}

// Where a ray is within a cylinder along y.
Inside inside_cylinder(const Vector3d& middle, double radius, const Vector3d& origin,
                       const Vector3d& direction) {
  const double ox = origin.x() - middle.x(), oz = origin.z() - middle.z();
  const double dx = direction.x(), dz = direction.z();
  const double a = dx * dx + dz * dz, b = ox * dx + oz * dz;
  const double c = ox * ox + oz * oz - radius * radius;
  const double root = b * b - a * c;
  if (a == 0.0 || root < 0.0) return {kInfinity, -kInfinity, 0};
  return {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a, 0};
}

}  // namespace

TurningMirror::TurningMirror(const TurningMirrorConfig& config)
    : config_(config),
      axis_(rotation(config.axis_yaw_deg * kRadPerDeg, Vector3d::UnitZ()) *
            rotation(config.axis_roll_deg * kRadPerDeg, Vector3d::UnitX())) {}

std::optional<TurningMirror::Contact> TurningMirror::meet(const Vector3d& origin,
                                                          const Vector3d& direction,
                                                          double psi_rad) const {
  const Vector3d o = axis_.transpose() * (origin - config_.height_m * Vector3d::UnitZ());
  const Vector3d d = axis_.transpose() * direction;
  const double plate = psi_rad + config_.flex_deg * kRadPerDeg * elementary::sin(psi_rad);
  const Vector3d along_plate = across(plate + std::numbers::pi / 2.0);
  const std::array<Plane, 6> planes{
      {{across(plate + config_.phase_deg[0] * kRadPerDeg), config_.offset_m[0]},
       {-across(plate + config_.phase_deg[1] * kRadPerDeg), config_.offset_m[1]},
       {along_plate, config_.half_width_m},
       {-along_plate, config_.half_width_m},
       {Vector3d::UnitY(), config_.half_length_m},
       {-Vector3d::UnitY(), config_.half_length_m}}};
  const Inside hit = inside(planes, o, d);
  if (!hit.any()) return std::nullopt;
  const bool reflects = hit.entered == 0 || (hit.entered == 1 && !config_.single_sided);
  if (!reflects) return Contact{Part::kEdge, hit.from, Vector3d::Zero()};
  const Vector3d& n = planes[hit.entered].outward;
  return Contact{hit.entered == 0 ? Part::kFace0 : Part::kFace1, hit.from,
                 axis_ * (d - 2.0 * n.dot(d) * n)};
}

std::optional<double> TurningMirror::arm_range_m(const Vector3d& origin, const Vector3d& direction,
                                                 double psi_rad) const {
  const Vector3d o = axis_.transpose() * (origin - config_.height_m * Vector3d::UnitZ());
  const Vector3d d = axis_.transpose() * direction;
  const double below_axis = config_.height_m - config_.arm_distance_m;
  double nearest = kInfinity;
  for (const ArmRod& arm : config_.arms) {
    const double hangs = psi_rad - arm.angle_deg * kRadPerDeg - std::numbers::pi / 2.0;
    const Vector3d middle = config_.arm_distance_m * across(hangs);
    const double y0 = below_axis * cotangent(arm.beam_last_deg * kRadPerDeg);
    const double y1 = below_axis * cotangent(arm.beam_first_deg * kRadPerDeg);
    const std::array<Plane, 2> ends{{{Vector3d::UnitY(), y1}, {-Vector3d::UnitY(), -y0}}};
    const Inside rod = inside_cylinder(middle, config_.arm_radius_m, o, d);
    const Inside span = inside(ends, o, d);
    const Inside both{std::max(rod.from, span.from), std::min(rod.to, span.to), 0};
    if (both.any()) nearest = std::min(nearest, both.from);
  }
  return nearest < kInfinity ? std::optional(nearest) : std::nullopt;
}

}  // namespace voxlist::simulation
