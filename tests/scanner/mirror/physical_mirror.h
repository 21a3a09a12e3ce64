#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace voxlist::scanner {

/// A mirror plate as three points on each of its two faces, which light is traced to point by
/// point: what MirrorModel's formulas have to agree with.
class PhysicalMirror {
 public:
  struct Build {
    double height_m = 0.1;
    std::array<double, 2> offset_m{0.0, 0.0};  ///< face from the axis
    std::array<double, 2> phase_rad{0.0, 0.0};
    double yaw_rad = 0.0, roll_rad = 0.0;  ///< of the axis
  };
  struct Bounce {
    Eigen::Vector3d hit, direction;
    int face;
  };

  PhysicalMirror(const Build& build, double psi_rad) : build_(build) {
    for (const int face : {0, 1}) faces_[static_cast<std::size_t>(face)] = place(face, psi_rad);
  }

  /// A ray from the laser's optical centre (the origin) that meets a face from outside, nearest
  /// first; nothing when it meets none in front of the laser.
  std::optional<Bounce> trace(const Eigen::Vector3d& ray) const {
    std::optional<Bounce> nearest;
    for (const int face : {0, 1}) {
      const auto& [a, b, c] = faces_[static_cast<std::size_t>(face)];
      // t ray = a + u (b - a) + v (c - a)
      Eigen::Matrix3d system;
      system << ray, a - b, a - c;
      const Eigen::Vector3d t_u_v = system.fullPivLu().solve(a);
      const double outside = (b - a).cross(c - a).dot(-a);
      if (t_u_v.x() <= 0.0 || outside <= 0.0) continue;
      const Eigen::Vector3d hit = t_u_v.x() * ray;
      // The reflected ray comes from the laser's mirror image.
      const Eigen::Hyperplane<double, 3> plane = Eigen::Hyperplane<double, 3>::Through(a, b, c);
      const Eigen::Vector3d image = 2.0 * plane.projection(Eigen::Vector3d::Zero());
      if (!nearest || hit.norm() < nearest->hit.norm())
        nearest = Bounce{hit, (hit - image).normalized(), face};
    }
    return nearest;
  }

 private:
  using Face = std::array<Eigen::Vector3d, 3>;

  // Three points of a face, counter-clockwise seen from outside. A face starts in the plane x = 0
  // and is turned about the axis.
  Face place(int face, double psi_rad) const {
    using Eigen::AngleAxisd, Eigen::Vector3d;
    const auto f = static_cast<std::size_t>(face);
    const double flip_rad = face == 0 ? 0.0 : M_PI;
    const Eigen::Isometry3d T =
        Eigen::Translation3d(0.0, 0.0, build_.height_m) *
        AngleAxisd(build_.yaw_rad, Vector3d::UnitZ()) *
        AngleAxisd(build_.roll_rad, Vector3d::UnitX()) *
        AngleAxisd(-(psi_rad + build_.phase_rad[f] + flip_rad), Vector3d::UnitY());
    const double e = build_.offset_m[f];
    return {T * Vector3d(e, 0.0, 0.0), T * Vector3d(e, 1.0, 0.0), T * Vector3d(e, 0.0, 1.0)};
  }

  Build build_;
  std::array<Face, 2> faces_;
};

}  // namespace voxlist::scanner
