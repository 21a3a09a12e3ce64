#pragma once

#include <Eigen/Geometry>

#include "voxlist/geometry/pose.h"
#include "voxlist/scanner/sweep/mirror_model.h"

namespace voxlist::scanner {

/// How one scanner is built and where it sits on its robot: what calibration finds and the cloud
/// assembler needs. Keys of the table [cloud_assembler].
struct ScannerGeometry {
  double mirror_phase_0_deg = 0.0;
  double mirror_phase_1_deg = 0.0;
  double mirror_height_m = 0.1;
  double mirror_offset_0_m = 0.002;
  double mirror_offset_1_m = 0.002;
  double axis_yaw_deg = 0.0;
  double axis_roll_deg = 0.0;
  double latency_ms = 0.0;
  double mount_x_m = 0.0;
  double mount_y_m = 0.0;
  double mount_z_m = 0.6;
  double mount_roll_deg = 0.0;
  double mount_pitch_deg = 0.0;
  double mount_yaw_deg = 0.0;

  template <class Visitor>
  void visit(Visitor& v) {
    v("mirror_phase_0_deg", mirror_phase_0_deg, "side 0: true mirror angle minus MIRROR's", -360.0,
      360.0);
    v("mirror_phase_1_deg", mirror_phase_1_deg, "side 1: true mirror angle minus MIRROR's", -360.0,
      360.0);
    v("mirror_height_m", mirror_height_m, "mirror axis above the laser's optical centre", 0.01,
      1.0);
    v("mirror_offset_0_m", mirror_offset_0_m, "side 0: reflecting surface from the axis, outward",
      -0.05, 0.05);
    v("mirror_offset_1_m", mirror_offset_1_m, "side 1: reflecting surface from the axis, outward",
      -0.05, 0.05);
    v("axis_yaw_deg", axis_yaw_deg, "mirror axis against the laser's y axis, about z", -45.0, 45.0);
    v("axis_roll_deg", axis_roll_deg, "mirror axis against the laser's y axis, about x", -45.0,
      45.0);
    v("latency_ms", latency_ms, "LASER's time stamps are late by this against MIRROR's", -100.0,
      100.0);
    v("mount_x_m", mount_x_m, "middle of the mirror axis in base", -100.0, 100.0);
    v("mount_y_m", mount_y_m, "middle of the mirror axis in base", -100.0, 100.0);
    v("mount_z_m", mount_z_m, "middle of the mirror axis in base: above the floor", -100.0, 100.0);
    v("mount_roll_deg", mount_roll_deg, "scanner in base: turned about x first", -180.0, 180.0);
    v("mount_pitch_deg", mount_pitch_deg, "scanner in base: then about y", -180.0, 180.0);
    v("mount_yaw_deg", mount_yaw_deg, "scanner in base: then about z", -180.0, 180.0);
  }

  /// The optics, in the laser's frame.
  MirrorModel<> model() const;

  /// Laser coordinates to base: the scanner's frame is the laser's, raised to the mirror's axis.
  Pose3 T_base_laser() const;
};

}  // namespace voxlist::scanner
