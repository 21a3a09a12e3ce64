#include "voxlist/calibration/thin_surfaces.h"

#include <algorithm>
#include <cmath>

#include "voxlist/calibration/patches.h"
#include "voxlist/calibration/side_search.h"

namespace voxlist::calibration {
namespace {

// How thick a surface may be at first, to either side (m): a mirror that is 0.5 deg off smears a
// wall at 8 m by 0.14 m.
constexpr double kFirstTolerance_m = 0.15;

// The tolerance shrinks by this factor a round at most: faster, and beams are lost before the fit
// has brought them in. It is settled when it no longer shrinks below the second factor.
constexpr double kToleranceShrinks = 0.6;
constexpr double kToleranceIsSettled = 0.9;

// Beams within so many thicknesses (standard deviations) of a plane belong to it.
constexpr double kToleranceInThicknesses = 4.0;

// Thickness is never taken to be below this (m): simulated lasers without noise would divide by
// zero.
constexpr double kMinThickness_m = 0.001;

// Rounds with planes found anew, and again rounds with the same planes. Ten bound the loop; a few
// do.
constexpr int kRounds = 10;

// A surface with fewer beams on it is dropped.
constexpr int kMinContacts = 100;

// A floor or ceiling is within this of level with the start values (degrees).
constexpr double kLevelWithin_deg = 15.0;

// A parameter has settled when a round changes it by less than this share of its limit.
constexpr double kSettled = 0.02;

std::vector<Eigen::Vector3d> points_of(const SurfaceEvidence& evidence, const SurfaceFit& fit) {
  std::vector<Eigen::Vector3d> points;
  for (const MirrorBeam& beam : evidence.beams)
    points.push_back(point_scanner(beam, fit.parameters.data()));
  return points;
}

double robust_sd(std::vector<double> values) {
  constexpr double kSdPerMedian = 1.4826;
  if (values.empty()) return 0.0;
  for (double& value : values) value = std::abs(value);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return kSdPerMedian * *middle;
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

bool settled(const ParameterVector& a, const ParameterVector& b) {
  for (int i = 0; i < kParameters; ++i)
    if (std::abs(a[i] - b[i]) > kSettled * kParameterInfos[static_cast<std::size_t>(i)].limit)
      return false;
  return true;
}

}  // namespace

ThinSurfaces::ThinSurfaces(const std::vector<MirrorBeam>& beams,
                           const scanner::ScannerGeometry& start,
                           const std::array<bool, kParameters>& held, double level_sd_deg)
    : up_scanner_(start.T_base_laser().linear().transpose() * Eigen::Vector3d::UnitZ()),
      level_sd_rad_(level_sd_deg * kRadPerDeg),
      before_(parameters_of(start)),
      tolerance_m_(kFirstTolerance_m) {
  fit_.parameters = before_;
  evidence_.beams = beams;
  evidence_.expected = before_;
  evidence_.held = held;
  if (held[kPhase0] || held[kPhase1]) return;
  const double difference_rad = side_difference(beams, before_);
  fit_.parameters[kPhase0] -= difference_rad / 2.0;
  fit_.parameters[kPhase1] += difference_rad / 2.0;
}

bool ThinSurfaces::run() {
  for (int round = 0; round < kRounds; ++round) {
    find_planes_anew();
    if (!fit_once(false)) return false;
    const double previous_m = tolerance_m_;
    tolerance_m_ = std::max(kToleranceInThicknesses * spread_m(), kToleranceShrinks * tolerance_m_);
    if (tolerance_m_ > kToleranceIsSettled * previous_m) break;
  }
  for (int round = 0; round < kRounds; ++round) {
    const ParameterVector previous = fit_.parameters;
    if (!fit_once(true)) return false;
    if (settled(previous, fit_.parameters)) return true;
  }
  return false;
}

double ThinSurfaces::thickness_before_m() const {
  constexpr double kNobodyIsFar_m = 1.0;
  SurfaceEvidence before = evidence_;
  before.held.fill(true);
  before.thickness_m = kNobodyIsFar_m;
  return rms(distances(before, make_thin(before, {before_, fit_.planes})));
}

double ThinSurfaces::thickness_after_m() const { return rms(distances(evidence_, fit_)); }

void ThinSurfaces::find_planes_anew() {
  fit_.planes = find_planes(points_of(evidence_, fit_), tolerance_m_);
}

// False when no surface is left.
bool ThinSurfaces::fit_once(bool even_patches_only) {
  touch();
  if (even_patches_only) drop_uneven_patches(evidence_, fit_);
  forget_small_planes();
  if (evidence_.contacts.empty()) return false;
  evidence_.level = level_plane();
  fit_ = make_thin(evidence_, fit_);
  return true;
}

void ThinSurfaces::touch() {
  const auto nearest = associate(points_of(evidence_, fit_), fit_.planes, tolerance_m_);
  evidence_.contacts.clear();
  for (std::size_t beam = 0; beam < nearest.size(); ++beam)
    if (nearest[beam]) evidence_.contacts.push_back({beam, *nearest[beam]});
  evidence_.thickness_m = spread_m();
}

void ThinSurfaces::forget_small_planes() {
  std::vector<int> counts(fit_.planes.size(), 0);
  for (const Contact& contact : evidence_.contacts) ++counts[contact.plane];
  std::vector<std::size_t> index(fit_.planes.size(), 0);
  std::vector<Plane> kept;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    index[i] = kept.size();
    if (counts[i] >= kMinContacts) kept.push_back(fit_.planes[i]);
  }
  std::erase_if(evidence_.contacts,
                [&](const Contact& contact) { return counts[contact.plane] < kMinContacts; });
  for (Contact& contact : evidence_.contacts) contact.plane = index[contact.plane];
  fit_.planes = std::move(kept);
}

// The largest one below the scanner, else above it.
std::optional<LevelPlane> ThinSurfaces::level_plane() const {
  const double most = std::cos(kLevelWithin_deg * kRadPerDeg);
  for (const double side : {-1.0, 1.0})
    for (std::size_t i = 0; i < fit_.planes.size(); ++i)
      if (side * fit_.planes[i].normal.dot(up_scanner_) > most)
        return LevelPlane{i, up_scanner_, level_sd_rad_};
  return std::nullopt;
}

double ThinSurfaces::spread_m() const {
  return std::max(kMinThickness_m, robust_sd(distances(evidence_, fit_)));
}

}  // namespace voxlist::calibration
