#include "voxlist/scanner/sweep/scanner_geometry.h"

#include "voxlist/geometry/angle.h"
#include "voxlist/geometry/mount.h"

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
  Pose3 T =
      mount_pose({mount_x_m, mount_y_m, mount_z_m}, mount_roll_deg, mount_pitch_deg, mount_yaw_deg);
  T.translation() -= mirror_height_m * T.linear().col(2);
  return T;
}

}  // namespace voxlist::scanner
