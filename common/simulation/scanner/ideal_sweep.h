#pragma once

#include <cstdint>

#include "voxlist/geometry/cloud.h"
#include "voxlist/simulation/scanner/mirror_scanner.h"

namespace voxlist::simulation {

/// Which beams of a sweep become points, where no driver, no monitor and no assembler take part.
struct IdealSweepConfig {
  double sweep_s = 1.0;  ///< the beam once round: half a turn of the mirror
  int lines_per_second = 75;
  int beam_first_deg = 25;  ///< beams, 1 deg apart
  int beam_last_deg = 155;
  double blind_up_deg = 15.0;    ///< half-width of the wedge where the mirror is edge-on
  double blind_down_deg = 60.0;  ///< half-width of the wedge that the robot itself fills
  double range_min_m = 0.5;      ///< from the optical centre, over the mirror
  double range_max_m = 8.0;
  double range_sd_m = 0.015;
};

/// The sweep that ends at `t_end_s`: the true points that beams hit, with noise along the beam,
/// moved into base at the sweep's end by `measured`, the motion that the robot believes in (the
/// truth itself: a perfect de-skew). Origins are where the rays left the mirror. About 5600 points.
/// The mirror begins each sweep edge-on. The noise depends on the seed and on nothing else that was
/// asked for before.
Cloud scan_sweep(const MirrorScanner& scanner, const Trajectory& measured, double t_end_s,
                 const IdealSweepConfig& config, std::uint64_t seed);

}  // namespace voxlist::simulation
