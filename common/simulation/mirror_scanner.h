#pragma once

#include <cstdint>

#include "geometry/cloud.h"
#include "simulation/building.h"
#include "simulation/trajectory.h"

namespace voxlist {

/// A 2D laser (SICK LMS 200) that looks up at a turning two-sided mirror, which throws its fan all
/// round. The mirror's axis is parallel to base's y axis; a beam leaves it at angle a from the axis
/// and at phi about it, phi = 0 upwards.
struct MirrorScannerConfig {
  double sweep_s = 1.0;  ///< the beam once round: half a turn of the mirror
  int lines_per_second = 75;
  int beam_first_deg = 25;  ///< beams, 1 deg apart, that the mirror is long enough for
  int beam_last_deg = 155;
  double blind_up_deg = 15.0;  ///< half-width of the wedge where the mirror is edge-on to the laser
  double blind_down_deg = 60.0;  ///< half-width of the wedge that the robot itself fills
  double laser_height_m = 0.5;   ///< the laser's optical centre above the floor, over base's origin
  double mirror_height_m = 0.1;  ///< the mirror's axis above the optical centre
  double range_min_m = 0.5;      ///< from the optical centre, over the mirror
  double range_max_m = 8.0;
  double range_sd_m = 0.015;
};

/// The sweep that ends at `t_end_s`: each beam is cast from where the robot truly is when it
/// leaves, then all are brought into base at the sweep's end by `measured`, the motion that the
/// robot believes in (the truth itself: a perfect de-skew). Origins are the points on the mirror's
/// axis. About 5600 points. The noise depends on the seed and on nothing else that was asked for
/// before.
Cloud scan_sweep(const Building& building, const Trajectory& truth, const Trajectory& measured,
                 double t_end_s, const MirrorScannerConfig& config, std::uint64_t seed);

}  // namespace voxlist
