#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "voxlist/calibration/calibrate.h"
#include "voxlist/geometry/pose.h"
#include "voxlist/simulation/building/box_tree.h"

namespace voxlist::test {

/// An upright round thing: column, bin, person.
struct Cylinder {
  Eigen::Vector2d centre_m;
  double radius_m, bottom_m, top_m;
};

/// Where a robot stands and records. Floor at z = 0.
struct TestRoom {
  std::string name;
  std::vector<simulation::Box> boxes;
  std::vector<Cylinder> cylinders;
  Pose2 T_map_base;

  /// People walk to and fro between these, at 1 m/s.
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> walks;
};

TestRoom office();
TestRoom corridor();
TestRoom hall();

/// Walls, floor and ceiling only; which of them.
TestRoom box_room(const Eigen::Vector3d& size, bool floor = true, bool ceiling = true);

/// One wall and nothing else.
TestRoom lone_wall();

/// How a log is recorded.
struct RecordingOptions {
  scanner::ScannerGeometry truth;
  std::vector<double> sweeps_s{1.0};  ///< one after the other, each as long
  double duration_s = 60.0;
  double range_sd_m = 0.005;
  bool single_sided = false;
  std::uint64_t seed = 1;
};

/// Lines of an LMS 200 (whole millimetres, to 8.183 m) under a turning plate of 0.1 m width, traced
/// ray by ray without MirrorModel.
calibration::CalibrationInput record(const TestRoom& room, const RecordingOptions& options);

/// Distances between where points 6 m from the scanner are and where a geometry puts them, over all
/// directions, at this sweep time.
struct SystematicError {
  double rms_m = 0.0, max_m = 0.0;
};
SystematicError systematic_error(const scanner::ScannerGeometry& found,
                                 const scanner::ScannerGeometry& truth, double sweep_s);

/// The errors of issue and paper on the default scanner.
scanner::ScannerGeometry miscalibrated();

}  // namespace voxlist::test
