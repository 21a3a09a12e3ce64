#include "voxlist/scanner/sweep/beam_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "voxlist/geometry/angle.h"
#include "voxlist/scanner/sweep/cloud_assembler_config.h"

namespace voxlist::scanner {
namespace {

// A beam at the very first or last angle belongs to the mirror, however its angle was rounded
// (rad).
constexpr double kAngleSlack_rad = 1e-4;

}  // namespace

BeamGeometry::BeamGeometry(const CloudAssemblerConfig& config)
    : model_(config.geometry.model()),
      T_base_laser_(config.geometry.T_base_laser()),
      first_rad_(config.beam_first_deg * kRadPerDeg - kAngleSlack_rad),
      last_rad_(config.beam_last_deg * kRadPerDeg + kAngleSlack_rad),
      range_min_m_(config.range_min_m),
      range_max_m_(config.range_max_m),
      robot_(config.robot_boxes_m, "robot_boxes_m") {
  if (first_rad_ >= last_rad_)
    throw std::invalid_argument("beam_first_deg must be below beam_last_deg");
  if (range_min_m_ >= range_max_m_)
    throw std::invalid_argument("range_min_m must be below range_max_m");
  const auto& blind = config.blind_phi_deg;
  if (blind.size() % 2 != 0) throw std::invalid_argument("blind_phi_deg must be pairs from, to");
  for (std::size_t i = 0; i < blind.size(); i += 2) {
    if (blind[i] >= blind[i + 1])
      throw std::invalid_argument("blind_phi_deg: each from must be below its to");
    blind_.push_back({blind[i] * kRadPerDeg, (blind[i + 1] - blind[i]) * kRadPerDeg});
  }
}

BeamFate BeamGeometry::follow(double psi_rad, double beam_rad, float range_m, BeamHit& hit) const {
  if (beam_rad < first_rad_ || beam_rad > last_rad_) return BeamFate::kOffMirror;
  const MirrorModel<>::Ray ray = model_.reflect(psi_rad, beam_rad);
  if (is_blind(phi_rad(psi_rad, ray.side))) return BeamFate::kBlind;
  if (std::isnan(range_m)) return BeamFate::kNoMeasurement;
  if (std::isinf(range_m)) return BeamFate::kNoReturn;
  const double range_from_mirror_m = static_cast<double>(range_m) - ray.path_m;
  // Nearly edge-on, the plane that the plate lies in may be met anywhere, even below the laser.
  if (!(ray.path_m > 0.0)) return BeamFate::kOffMirror;
  if (range_from_mirror_m < 0.0) return BeamFate::kBeforeMirror;
  if (range_from_mirror_m < range_min_m_) return BeamFate::kTooNear;
  if (range_from_mirror_m > range_max_m_) return BeamFate::kTooFar;
  const Eigen::Vector3d point =
      T_base_laser_ * (ray.origin_m + range_from_mirror_m * ray.direction);
  if (robot_.hold(point)) return BeamFate::kRobot;
  hit = {T_base_laser_ * ray.origin_m, point};
  return BeamFate::kPoint;
}

int BeamGeometry::side(double psi_rad) const {
  return model_.reflect(psi_rad, std::numbers::pi / 2.0).side;
}

double BeamGeometry::phi_rad(double psi_rad, int side) const {
  return 2.0 * (psi_rad + model_.phase_rad[static_cast<std::size_t>(side)]);
}

bool BeamGeometry::is_blind(double phi_rad) const {
  return std::ranges::any_of(blind_, [phi_rad](const Interval& interval) {
    const double turns = (phi_rad - interval.from_rad) / kTurn_rad;
    return (turns - std::floor(turns)) * kTurn_rad <= interval.width_rad;
  });
}

}  // namespace voxlist::scanner
