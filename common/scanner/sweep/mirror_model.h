#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "voxlist/geometry/elementary.h"

namespace voxlist::scanner {

/// The optics of a 2D laser that looks up at a turning two-sided mirror. Laser frame: the optical
/// centre, the scan plane is y-z, z up; beam a leaves in direction (0, cos a, sin a). The mirror's
/// axis runs through (0, 0, height_m), nominally along y. Templated for automatic differentiation.
///
/// At mirror angle psi, side s has the outward normal
///   n_s = +-R_axis (cos psi_s, 0, sin psi_s),  psi_s = psi + phase_rad[s],  + for s = 0,
/// and its reflecting surface is the plane n_s . (p - (0, 0, height)) = offset_m[s].
template <class T = double>
struct MirrorModel {
  std::array<T, 2> phase_rad{T(0), T(0)};  ///< per side: true mirror angle minus reported
  T height_m = T(0.1);                     ///< h: axis above the optical centre
  std::array<T, 2> offset_m{T(0), T(0)};   ///< e: reflecting surface from the axis, outward
  T axis_yaw_rad = T(0);                   ///< the axis turned about z, then
  T axis_roll_rad = T(0);                  ///< about x

  /// The ray that leaves the mirror, in the laser's frame.
  struct Ray {
    Eigen::Matrix<T, 3, 1> origin_m;   ///< where the beam meets the mirror
    Eigen::Matrix<T, 3, 1> direction;  ///< unit
    T path_m;                          ///< from the optical centre to the mirror
    int side;
  };

  /// The beam at angle `beam_rad` reflected by the mirror at psi: by whichever side faces it. Exact
  /// for any tilt and offset (mirror law d' = d - 2 (d.n) n); reference formulas of
  /// the paper's section II are the special case e = 0 without tilt. Whether the plate is wide
  /// enough is not asked: near edge-on (phi = 2 psi near 0) the answer is no measurement.
  Ray reflect(const T& psi_rad, double beam_rad) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const auto [sine, cosine] = elementary::sine_cosine(beam_rad);
    const Vector d(T(0), T(cosine), T(sine));
    const int side = facing_side(psi_rad, d);
    const Vector n = normal(psi_rad, side);
    const Vector axis_point(T(0), T(0), height_m);
    const auto s = static_cast<std::size_t>(side);
    const T path = (n.dot(axis_point) + offset_m[s]) / n.dot(d);
    return {path * d, d - T(2) * n.dot(d) * n, path, side};
  }

 private:
  Eigen::Matrix<T, 3, 1> normal(const T& psi_rad, int side) const {
    using elementary::cos, elementary::sin;  // Ceres has its own for its numbers
    const T psi = psi_rad + phase_rad[static_cast<std::size_t>(side)];
    const T sign = T(side == 0 ? 1 : -1);
    // R_axis = Rz(yaw) Rx(roll), on (cos psi, 0, sin psi).
    const T x = sign * cos(psi), z = sign * sin(psi);
    const T y_rolled = -sin(axis_roll_rad) * z, z_rolled = cos(axis_roll_rad) * z;
    return {cos(axis_yaw_rad) * x - sin(axis_yaw_rad) * y_rolled,
            sin(axis_yaw_rad) * x + cos(axis_yaw_rad) * y_rolled, z_rolled};
  }

  int facing_side(const T& psi_rad, const Eigen::Matrix<T, 3, 1>& d) const {
    return normal(psi_rad, 0).dot(d) < T(0) ? 0 : 1;
  }
};

}  // namespace voxlist::scanner
