#include "voxlist/calibration/patches.h"

#include <cmath>
#include <map>

namespace voxlist::calibration {
namespace {

// Edge of a patch (m): as large as a picture on the wall or the front of a cupboard.
constexpr double kPatch_m = 0.5;

// A patch is even when its mean is within so many thicknesses of its plane. At 0.5 the fronts of
// two cupboards 8 mm apart are two surfaces; at 1 they are one, tilted.
constexpr double kEven = 0.5;

struct Mean {
  double sum = 0.0;
  int count = 0;
  double value() const { return sum / count; }
};

}  // namespace

Patch patch_of(const SurfaceEvidence& evidence, const SurfaceFit& fit, const Contact& contact) {
  const Eigen::Vector3d point =
      point_scanner(evidence.beams[contact.beam], fit.parameters.data()) / kPatch_m;
  Eigen::Index across = 0;
  fit.planes[contact.plane].normal.cwiseAbs().maxCoeff(&across);
  const auto index = [&](Eigen::Index i) {
    return static_cast<int>(std::floor(point[(across + i) % 3]));
  };
  return {contact.plane, index(1), index(2)};
}

void drop_uneven_patches(SurfaceEvidence& evidence, const SurfaceFit& fit) {
  const std::vector<double> off_m = distances(evidence, fit);
  std::map<Patch, Mean> means;
  std::vector<Patch> patches;
  for (std::size_t i = 0; i < off_m.size(); ++i) {
    patches.push_back(patch_of(evidence, fit, evidence.contacts[i]));
    Mean& mean = means[patches.back()];
    mean.sum += off_m[i];
    ++mean.count;
  }
  std::vector<Contact> kept;
  for (std::size_t i = 0; i < off_m.size(); ++i)
    if (std::abs(means[patches[i]].value()) <= kEven * evidence.thickness_m)
      kept.push_back(evidence.contacts[i]);
  evidence.contacts = std::move(kept);
}

}  // namespace voxlist::calibration
