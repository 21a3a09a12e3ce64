#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/geometry/pose.h"
#include "voxlist/geometry/tilt.h"
#include "voxlist/matching/engines/matcher.h"
#include "voxlist/matching/localisation/confidence.h"
#include "voxlist/matching/motion/odometry_check.h"
#include "voxlist/matching/motion/tracked_pose.h"
#include "voxlist/matching/scan/floor.h"

namespace voxlist::matching {

/// How sure the localiser is of its pose.
enum class LocalisationState {
  /// No pose fits.
  kLost = 0,
  /// Several poses fit about as well: the modes name them.
  kAmbiguous = 1,
  /// The first mode is the pose. Only such clouds go into the map.
  kTracking = 2,
};

/// LOST, AMBIGUOUS or TRACKING.
const char* name(LocalisationState state);

/// A candidate for the robot's pose.
struct PoseMode {
  Pose2 T_map_base;
  /// What T_map_base leaves out of the whole pose. All 0 where poses are planar.
  Tilt tilt;
  /// Of (x, y, yaw): m^2, m rad, rad^2.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Matched points whose cell is occupied in the dilated map, as a share, 0..1.
  double overlap_ratio = 0.0;
  /// How well map and scan agree there. 0 while tracking.
  PoseSupport support;
  /// That this mode is right, 0..1; all modes' together are less than 1: none of them may be.
  double probability = 0.0;
};

/// Whether its covariance (of x, y, yaw) lets a pose be told as one: known to 0.3 m, one standard
/// deviation, in the worst direction.
bool is_exact(const Eigen::Matrix3d& covariance);

/// What is known of where one cloud was taken.
struct Localisation {
  std::int64_t utime_us = 0;
  LocalisationState state = LocalisationState::kLost;
  /// Best first; may be empty when LOST.
  std::vector<PoseMode> modes;
  /// log10 of the probability of the overlap by chance (paper, section IV), over all poses of the
  /// lattice.
  double significance_log10 = 0.0;
  /// Poses that are not listed may have this share of the first mode's support; 1: nobody knows.
  /// Told by a search of the whole map.
  double unseen = 1.0;
  /// Probability that the first mode is right, 0..1.
  double confidence = 0.0;
  /// What odometry is off by all the time, as far as scans have told; nothing without odometry, or
  /// when not TRACKING.
  std::optional<OdometryBias> odometry_bias;
  /// No pose of the searched lattice overlaps more than the best one found.
  bool certified = false;
  /// The whole map was searched, not a window around a prediction.
  bool searched_whole_map = false;
  std::int64_t poses_examined = 0;
  /// What odometry was off by on its way here, where it is known: while tracking.
  std::optional<OdometryError> odometry_error;
  /// The floor as the cloud shows it; nothing where too little of it is in sight.
  std::optional<Floor> floor;

  bool tracking() const { return state == LocalisationState::kTracking; }
};

/// The modes that an engine found, as yet without a state.
Localisation from_match(const PreparedScan& scan, const Match& match);

}  // namespace voxlist::matching
