#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "voxlist/calibration/mirror_beam.h"
#include "voxlist/calibration/parameters.h"
#include "voxlist/calibration/planes.h"

namespace voxlist::calibration {

/// A beam that met a plane, by their indices.
struct Contact {
  std::size_t beam, plane;
};

/// Which plane is known to be level, and how well.
struct LevelPlane {
  std::size_t plane;
  Eigen::Vector3d up_scanner;
  double sd_rad;
};

/// Parameters and planes that shall agree with each other.
struct SurfaceFit {
  ParameterVector parameters;
  std::vector<Plane> planes;
};

/// What a fit has to agree with: contacts of beams with planes, and what is known beside them.
struct SurfaceEvidence {
  std::span<const MirrorBeam> beams;
  std::vector<Contact> contacts;
  double thickness_m;  ///< standard deviation of the contacts about their planes

  /// Without one nothing holds the cloud's turn about the mirror's axis.
  std::optional<LevelPlane> level;

  /// Parameters that keep their values.
  std::array<bool, kParameters> held{};

  /// The others are near these, within kParameterInfos' plausible: loose, so that a parameter that
  /// no beam sees stays finite.
  ParameterVector expected;
};

/// Makes the surfaces thin: the parameters and planes, from these on, with the least robust
/// distances between beams and their planes.
SurfaceFit make_thin(const SurfaceEvidence& evidence, const SurfaceFit& from);

/// Standard deviations of the parameters of such a fit; 0 for held ones. Neighbouring points share
/// the unevenness of their surface, so patches of half a metre, not points, count as independent
/// (a cluster-robust covariance).
ParameterVector standard_deviations(const SurfaceEvidence& evidence, const SurfaceFit& fit);

/// Signed distances of the contacts from their planes, metres.
std::vector<double> distances(const SurfaceEvidence& evidence, const SurfaceFit& fit);

}  // namespace voxlist::calibration
