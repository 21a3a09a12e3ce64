#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "voxlist/geometry/mount.h"
#include "voxlist/scanner/sweep/mirror_model.h"

namespace voxlist::scanner {

struct CloudAssemblerConfig;

/// What became of a beam.
enum class BeamFate {
  kPoint,
  kOffMirror,      ///< passed the mirror's ends, or its edge
  kBlind,          ///< thrown into a wedge that is left out
  kNoMeasurement,  ///< NaN
  kNoReturn,       ///< +infinity
  kBeforeMirror,   ///< hit an arm or the plate's edge
  kTooNear,
  kTooFar,
  kRobot,  ///< hit the robot itself
};
inline constexpr std::size_t kBeamFates = 9;

/// A ray in base: where it left the mirror, and what it hit. Metres.
struct BeamHit {
  Eigen::Vector3d origin;
  Eigen::Vector3d point;
};

/// One beam's way: laser, mirror, world, and whether what it hit is a point of the cloud.
class BeamGeometry {
 public:
  /// Throws std::invalid_argument when the config's lists are no pairs and boxes, or leave nothing.
  explicit BeamGeometry(const CloudAssemblerConfig& config);

  /// Follows the beam at angle `beam_rad` with the mirror at `psi_rad`. `hit`, in base as it was
  /// when the beam left, is written only with kPoint.
  BeamFate follow(double psi_rad, double beam_rad, float range_m, BeamHit& hit) const;

  /// Which side of the mirror faces the laser.
  int side(double psi_rad) const;

  /// The angle about the mirror's axis of what that side reflects, continuous with psi: twice it.
  double phi_rad(double psi_rad, int side) const;

 private:
  bool is_blind(double phi_rad) const;

  struct Interval {
    double from_rad, width_rad;
  };

  MirrorModel<> model_;
  Eigen::Isometry3d T_base_laser_;
  double first_rad_, last_rad_;
  double range_min_m_, range_max_m_;
  std::vector<Interval> blind_;
  BodyBoxes robot_;
};

}  // namespace voxlist::scanner
