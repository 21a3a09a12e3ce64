#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace voxlist::simulation {

/// A thin rod, parallel to the axis, that turns with the mirror. At shaft angle `angle_deg` it
/// hangs straight down from the axis and covers the laser's beams from `beam_first_deg` to
/// `beam_last_deg`.
struct ArmRod {
  double angle_deg = 90.0;
  double beam_first_deg = 25.0, beam_last_deg = 60.0;
};

/// A two-sided mirror that turns about an axis over a 2D laser, as it truly is: a rectangular plate
/// with thickness, and arms. In the laser's frame (common/geometry/laser_line.h: fan in the y-z
/// plane, z up along beam 90 deg) the axis runs through (0, 0, height_m), along y but for the
/// tilts.
struct TurningMirrorConfig {
  double height_m = 0.1;
  double half_width_m = 0.05;                    ///< from the axis to the plate's long edges
  double half_length_m = 0.25;                   ///< along the axis
  std::array<double, 2> offset_m{0.002, 0.002};  ///< of each face from the axis, outward
  std::array<double, 2> phase_deg{0.0, 0.0};     ///< of each face, against the shaft
  double axis_yaw_deg = 0.0;                     ///< the axis turned about z, after
  double axis_roll_deg = 0.0;                    ///< about x
  double flex_deg = 0.0;      ///< the plate's angle is the shaft's + flex sin(shaft's)
  bool single_sided = false;  ///< face 1 reflects nothing
  std::vector<ArmRod> arms{{90.0, 25.0, 60.0}, {265.0, 120.0, 155.0}};
  double arm_distance_m = 0.06;  ///< of the rods' middles from the axis
  double arm_radius_m = 0.006;
};

/// The plate and the arms, for ray casting. All coordinates are the laser's; shaft angle psi: face
/// 0's outward normal is (cos psi, 0, sin psi), face 1's the opposite.
class TurningMirror {
 public:
  explicit TurningMirror(const TurningMirrorConfig& config);

  enum class Part { kFace0, kFace1, kEdge };

  /// Where a ray meets the plate, and for a face where it goes on (unit; for an edge, zero).
  struct Contact {
    Part part;
    double distance_m;
    Eigen::Vector3d reflected;
  };

  /// A ray's first contact with the plate; none when it passes by.
  std::optional<Contact> meet(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                              double psi_rad) const;

  /// Distance to the first arm on the ray, if any.
  std::optional<double> arm_range_m(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                    double psi_rad) const;

  const TurningMirrorConfig& config() const { return config_; }

 private:
  const TurningMirrorConfig config_;
  Eigen::Matrix3d axis_;  // takes the axis' own frame, whose y is the axis, to the laser's
};

}  // namespace voxlist::simulation
