#pragma once

#include <array>
#include <optional>
#include <vector>

#include "voxlist/calibration/surface_fit.h"
#include "voxlist/scanner/sweep/scanner_geometry.h"

namespace voxlist::calibration {

/// One log's way from the start values to parameters that make its surfaces thin.
class ThinSurfaces {
 public:
  /// `beams` must outlive it. Held parameters keep their values.
  ThinSurfaces(const std::vector<MirrorBeam>& beams, const scanner::ScannerGeometry& start,
               const std::array<bool, kParameters>& held, double level_sd_deg);

  /// Finds surfaces and fits, with a narrower idea of a surface each time, until they are as thin
  /// as they get; then only beams come and go, until the parameters settle. Whether they do.
  bool run();

  /// What the last fit stands on; no contacts when there is no surface.
  const SurfaceEvidence& evidence() const { return evidence_; }
  const SurfaceFit& fit() const { return fit_; }

  /// RMS distance of the contacts from the planes that fit best with the start values, and now.
  double thickness_before_m() const;
  double thickness_after_m() const;

 private:
  void find_planes_anew();
  bool fit_once(bool even_patches_only);
  void touch();
  void forget_small_planes();
  std::optional<LevelPlane> level_plane() const;
  double spread_m() const;

  const Eigen::Vector3d up_scanner_;
  const double level_sd_rad_;
  const ParameterVector before_;
  double tolerance_m_;
  SurfaceEvidence evidence_;
  SurfaceFit fit_;
};

}  // namespace voxlist::calibration
