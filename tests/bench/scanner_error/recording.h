#pragma once

#include <memory>
#include <vector>

#include "calibration/calibrate.h"
#include "simulation/mirror_scanner.h"

namespace voxlist {

/// The room of the paper's Fig. 8, half its inner size, and where the robot stands in it; its
/// middle is the origin, the floor z = 0.
inline const Eigen::Vector3d kRoomHalf_m(1.5, 3.0, 1.375);
inline constexpr Pose2 kStand{0.1, -0.2, 0.3};

/// A robot that stands in that room and scans it once a second.
class Recording {
 public:
  explicit Recording(const MirrorScannerConfig& config);

  /// LASER, and MIRROR by the monitor's own class, of a minute.
  const CalibrationInput& log() const { return log_; }

  /// The clouds that the assembler makes of the log's last seconds.
  std::vector<Cloud> clouds(const CloudAssemblerConfig& assembler) const;

  /// A point of the room's surfaces, and where the scanner puts it without noise. Base.
  struct SeenPoint {
    Eigen::Vector3d truth, seen;
  };

  /// Those of the mirror's last whole turn: two sweeps, one by each side.
  std::vector<SeenPoint> noise_free_turn(const CloudAssemblerConfig& assembler) const;

 private:
  const MirrorScannerConfig config_;
  const World world_;
  const Trajectory stands_;
  const MirrorScanner scanner_;
  CalibrationInput log_;
};

}  // namespace voxlist
