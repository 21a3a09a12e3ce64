#include "voxlist/scanner/sweep/scanner_geometry.h"

#include "voxlist/geometry/angle.h"

namespace voxlist::scanner {

MirrorModel<> ScannerGeometry::model() const {
  MirrorModel<> model;
  model.phase_rad = {mirror_phase_0_deg * kRadPerDeg, mirror_phase_1_deg * kRadPerDeg};
  model.height_m = mirror_height_m;
  model.offset_m = {mirror_offset_0_m, mirror_offset_1_m};
  model.axis_yaw_rad = axis_yaw_deg * kRadPerDeg;
  model.axis_roll_rad = axis_roll_deg * kRadPerDeg;
  return model;
}

Pose3 ScannerGeometry::T_base_laser() const {
  using Eigen::Vector3d;
  Pose3 T = Pose3::Identity();
  T.linear() = rotation(mount_yaw_deg * kRadPerDeg, Vector3d::UnitZ()) *
               rotation(mount_pitch_deg * kRadPerDeg, Vector3d::UnitY()) *
               rotation(mount_roll_deg * kRadPerDeg, Vector3d::UnitX());
  T.translation() = Vector3d(mount_x_m, mount_y_m, mount_z_m) - mirror_height_m * T.linear().col(2);
  return T;
}

}  // namespace voxlist::scanner
