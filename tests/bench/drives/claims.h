#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/drives/scanned_drive.h"
#include "tests/bench/figures.h"
#include "voxlist/matching/localisation/localisation.h"

namespace voxlist::bench {

/// How a claimed pose is off.
struct PoseError {
  double off_m = 0.0;
  /// The pose's error in standard deviations, in the worst direction of those that are known to no
  /// better than 2 cm.
  double sigmas = 0.0;

  bool far() const { return off_m > 0.3; }
  bool beyond_claim() const { return sigmas > 3.0; }
};

PoseError error_of(const matching::PoseMode& mode, const Pose2& truth);

/// How often the first mode was right where its probability was said to be so much.
struct Reliability {
  struct Bin {
    int modes = 0, right = 0;
    double said = 0.0;
  };
  static constexpr std::array<double, 9> kUpTo{0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.99, 0.999, 1.01};
  std::array<Bin, kUpTo.size()> bins;

  void add(double said, bool is_right);
  void print() const;
};

/// What a drive's localiser claimed, counted. Bad scans count as wrong when a wrong pose is claimed
/// of them, and not else.
struct DriveClaims {
  int scans = 0, tracking = 0, near = 0, far = 0, beyond_claim = 0, ambiguous = 0, lost = 0;
  /// Rows of bad scans, and after how many the next good one (the second one at the latest) was
  /// TRACKING.
  int bad_rows = 0, at_next = 0, within_two = 0;
  /// Robots that were carried away while TRACKING, and those not TRACKING at a wrong pose two scans
  /// later.
  int carried = 0, noticed = 0;
  std::vector<double> localise_ms, map_ms;

  void add(const DriveClaims& other);
  int wrong() const { return far + beyond_claim; }
};

/// One drive, localised scan by scan as the mapper and the localiser do it: in the finished map or
/// in the one that its TRACKING scans make. `list`: prints a line for each wrong claim.
DriveClaims claims_of(const DriveSpec& spec, int seed, int i, const OccupancyMap* finished,
                      Reliability& reliability, bool list = false);

}  // namespace voxlist::bench
