#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "voxlist/calibration/parameters.h"
#include "voxlist/geometry/laser_line.h"
#include "voxlist/geometry/mirror_state.h"
#include "voxlist/scanner/sweep/cloud_assembler_config.h"

namespace voxlist::calibration {

/// A beam that left the mirror and met something.
struct MirrorBeam {
  double beam_rad;
  double range_m;     ///< from the optical centre, over the mirror
  double psi_rad;     ///< the mirror's angle by MIRROR at the beam's time by LASER
  double rate_radps;  ///< the mirror's
};

/// Where a beam met something, in the scanner's frame (the middle of the mirror's axis). Templated
/// for automatic differentiation.
template <class T>
Eigen::Matrix<T, 3, 1> point_scanner(const MirrorBeam& beam, const T* parameters) {
  const scanner::MirrorModel<T> model = mirror_model(parameters);
  const T psi = T(beam.psi_rad) - T(beam.rate_radps) * parameters[kLatency];
  const auto ray = model.reflect(psi, beam.beam_rad);
  const Eigen::Matrix<T, 3, 1> axis(T(0), T(0), model.height_m);
  return ray.origin_m + (T(beam.range_m) - ray.path_m) * ray.direction - axis;
}

/// The beams of a log.
struct BeamSet {
  std::vector<MirrorBeam> beams;
  std::size_t lines = 0;                 ///< with a mirror angle
  std::size_t lines_without_mirror = 0;  ///< no MIRROR near them
};

/// Gives each beam the mirror's angle, keeps those that the cloud assembler would make points of,
/// and evenly chooses `max_beams` of them. Lines and states in the order of time, states as of
/// steadied().
BeamSet gather_beams(const std::vector<LaserLine>& lines, const std::vector<MirrorState>& mirror,
                     const scanner::CloudAssemblerConfig& scanner, std::size_t max_beams);

}  // namespace voxlist::calibration
