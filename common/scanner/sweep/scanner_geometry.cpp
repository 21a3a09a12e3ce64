#include "voxlist/scanner/sweep/scanner_geometry.h"

#include <numbers>

namespace voxlist::scanner {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

}  // namespace

MirrorModel<> ScannerGeometry::model() const {
  MirrorModel<> model;
  model.phase_rad = {mirror_phase_0_deg * kRadians, mirror_phase_1_deg * kRadians};
  model.height_m = mirror_height_m;
  model.offset_m = {mirror_offset_0_m, mirror_offset_1_m};
  model.axis_yaw_rad = axis_yaw_deg * kRadians;
  model.axis_roll_rad = axis_roll_deg * kRadians;
  return model;
}

Pose3 ScannerGeometry::T_base_laser() const {
  using Eigen::Vector3d;
  Pose3 T = Pose3::Identity();
  T.linear() = rotation(mount_yaw_deg * kRadians, Vector3d::UnitZ()) *
               rotation(mount_pitch_deg * kRadians, Vector3d::UnitY()) *
               rotation(mount_roll_deg * kRadians, Vector3d::UnitX());
  T.translation() = Vector3d(mount_x_m, mount_y_m, mount_z_m) - mirror_height_m * T.linear().col(2);
  return T;
}

}  // namespace voxlist::scanner
