#pragma once

#include <memory>
#include <vector>

#include "voxlist/calibration/calibrate.h"
#include "voxlist/simulation/scanner/mirror_scanner.h"

namespace voxlist::desk {

/// The room of the paper's Fig. 8, half its inner size, and where the robot stands in it; its
/// middle is the origin, the floor z = 0.
inline const Eigen::Vector3d kRoomHalf_m(1.5, 3.0, 1.375);
inline constexpr Pose2 kStand{0.1, -0.2, 0.3};

/// A robot that stands in that room and scans it once a second.
class ScannerRecording {
 public:
  explicit ScannerRecording(const simulation::MirrorScannerConfig& config);

  /// LASER, and MIRROR by the monitor's own class, of a minute.
  const calibration::CalibrationInput& input() const { return log_; }

  /// The clouds that the assembler makes of the log's last seconds.
  std::vector<Cloud> clouds(const scanner::CloudAssemblerConfig& assembler) const;

  /// A point of the room's surfaces, and where the scanner puts it without noise. Base.
  struct SeenPoint {
    Eigen::Vector3d truth, seen;
  };

  /// Those of the mirror's last whole turn: two sweeps, one by each side.
  std::vector<SeenPoint> noise_free_turn(const scanner::CloudAssemblerConfig& assembler) const;

 private:
  const simulation::MirrorScannerConfig config_;
  const simulation::World world_;
  const simulation::Trajectory stands_;
  const simulation::MirrorScanner scanner_;
  calibration::CalibrationInput log_;
};

}  // namespace voxlist::desk
