#include "calibration/calibrate.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "calibration/preconditions.h"
#include "calibration/side_search.h"
#include "calibration/surface_fit.h"

namespace voxlist {
namespace {

constexpr double kFirstTolerance_m = 0.15;
constexpr double kToleranceShrinks = 0.6;
constexpr double kToleranceInThicknesses = 4.0;
constexpr double kMinThickness_m = 0.001;
constexpr int kRounds = 16;
constexpr std::size_t kMinContacts = 100;  // of a surface
constexpr double kLevelWithin_deg = 15.0;

// A parameter has settled when a round changes it by less than this share of its limit.
constexpr double kSettled = 0.02;

std::vector<Eigen::Vector3d> points_of(std::span<const MirrorBeam> beams,
                                       const ParameterVector& parameters) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(beams.size());
  for (const MirrorBeam& beam : beams) points.push_back(point_scanner(beam, parameters.data()));
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

// One log's way from the start values to the answer.
class Rounds {
 public:
  Rounds(const std::vector<MirrorBeam>& beams, const ScannerGeometry& start,
         const std::array<bool, kParameters>& held, double level_sd_deg)
      : up_scanner_(start.T_base_laser().linear().transpose() * Eigen::Vector3d::UnitZ()),
        level_sd_rad_(level_sd_deg * kRadPerDeg),
        before_(parameters_of(start)) {
    fit_.parameters = before_;
    evidence_.beams = beams;
    evidence_.expected = before_;
    evidence_.held = held;
    if (held[kPhase0] || held[kPhase1]) return;
    const double difference_rad = side_difference(beams, before_);
    fit_.parameters[kPhase0] -= difference_rad / 2.0;
    fit_.parameters[kPhase1] += difference_rad / 2.0;
  }

  // Whether it settled.
  bool run() {
    for (int round = 0; round < kRounds; ++round) {
      const ParameterVector previous = fit_.parameters;
      const double tolerance_m = tolerance_m_;
      find_surfaces();
      if (evidence_.contacts.empty()) return false;
      fit_ = make_thin(evidence_, fit_);
      narrow();
      if (tolerance_m_ > 0.9 * tolerance_m && settled(previous, fit_.parameters)) return true;
    }
    return false;
  }

  const SurfaceEvidence& evidence() const { return evidence_; }
  const SurfaceFit& fit() const { return fit_; }

  double thickness_before_m() const {
    constexpr double kNobodyIsFar_m = 1.0;
    SurfaceEvidence before = evidence_;
    before.held.fill(true);
    before.thickness_m = kNobodyIsFar_m;
    return rms(distances(before, make_thin(before, {before_, fit_.planes})));
  }

  double thickness_after_m() const { return rms(distances(evidence_, fit_)); }

 private:
  void find_surfaces() {
    const auto points = points_of(evidence_.beams, fit_.parameters);
    const std::vector<Plane> found = find_planes(points, tolerance_m_);
    const auto nearest = associate(points, found, tolerance_m_);
    std::vector<std::size_t> counts(found.size(), 0);
    for (const auto& plane : nearest)
      if (plane) ++counts[*plane];
    take(found, counts);
    evidence_.contacts.clear();
    for (std::size_t beam = 0; beam < nearest.size(); ++beam)
      if (nearest[beam] && index_[*nearest[beam]])
        evidence_.contacts.push_back({beam, *index_[*nearest[beam]]});
    evidence_.thickness_m = std::max(kMinThickness_m, robust_sd(distances(evidence_, fit_)));
    evidence_.level = level_plane();
  }

  // Surfaces with enough beams, and their new numbers.
  void take(const std::vector<Plane>& found, const std::vector<std::size_t>& counts) {
    fit_.planes.clear();
    index_.assign(found.size(), std::nullopt);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (counts[i] < kMinContacts) continue;
      index_[i] = fit_.planes.size();
      fit_.planes.push_back(found[i]);
    }
  }

  // The largest one below the scanner, else above it.
  std::optional<LevelPlane> level_plane() const {
    for (const double side : {-1.0, 1.0})
      for (std::size_t i = 0; i < fit_.planes.size(); ++i)
        if (side * fit_.planes[i].normal.dot(up_scanner_) > std::cos(kLevelWithin_deg * kRadPerDeg))
          return LevelPlane{i, up_scanner_, level_sd_rad_};
    return std::nullopt;
  }

  void narrow() {
    const double wanted_m =
        kToleranceInThicknesses * std::max(kMinThickness_m, robust_sd(distances(evidence_, fit_)));
    tolerance_m_ = std::max(wanted_m, kToleranceShrinks * tolerance_m_);
  }

  const Eigen::Vector3d up_scanner_;
  const double level_sd_rad_;
  const ParameterVector before_;
  double tolerance_m_ = kFirstTolerance_m;
  SurfaceEvidence evidence_;
  SurfaceFit fit_;
  std::vector<std::optional<std::size_t>> index_;
};

CalibrationAnswer answer_of(const Rounds& rounds, const BeamSet& set) {
  CalibrationAnswer answer;
  answer.parameters = rounds.fit().parameters;
  answer.sd = standard_deviations(rounds.evidence(), rounds.fit());
  answer.held = rounds.evidence().held;
  answer.thickness_before_m = rounds.thickness_before_m();
  answer.thickness_after_m = rounds.thickness_after_m();
  answer.lines = set.lines;
  answer.beams = set.beams.size();
  answer.surfaces = rounds.fit().planes.size();
  return answer;
}

}  // namespace

Calibration calibrate(const CalibrationInput& input, const CloudAssemblerConfig& scanner,
                      const CalibrationConfig& config) {
  Calibration result;
  const ParameterVector before = parameters_of(scanner.geometry);
  const BeamSet set = gather_beams(input.lines, input.mirror, scanner, config.max_beams);
  result.refusals = unusable(input, set, config.min_lines);
  if (!result.refusals.empty()) return result;

  Held held = held_parameters(set.beams, before);
  Rounds rounds(set.beams, scanner.geometry, held.parameters, config.level_sd_deg);
  const bool has_settled = rounds.run();
  result.warnings = std::move(held.reasons);
  if (!rounds.evidence().contacts.empty()) {
    result.answer = answer_of(rounds, set);
    std::ranges::move(warnings_of(*result.answer, before), std::back_inserter(result.warnings));
  }
  result.refusals = refusals_of(result.answer, rounds.evidence().level.has_value(), has_settled);
  return result;
}

}  // namespace voxlist
