#include "voxlist/calibration/side_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace voxlist::calibration {
namespace {

// The room is counted in voxels of this edge (m). 0.25 deg moves the beam's end by 0.07 m at 8 m
// (the mirror doubles it), so a finer step would not change the count.
constexpr double kVoxel_m = 0.1;
constexpr double kStep_rad = 0.25 * kRadPerDeg;

// Steps to each side: 5 deg, more than a plate is glued off.
constexpr int kSteps = 20;

// About so many beams are counted: a sweep. More only take longer.
constexpr std::size_t kBeams = 8000;

std::size_t occupied(std::span<const MirrorBeam> beams, const ParameterVector& parameters) {
  const std::size_t stride = beams.size() / kBeams + 1;
  std::vector<std::array<int, 3>> voxels;
  for (std::size_t i = 0; i < beams.size(); i += stride) {
    const Eigen::Vector3d p = point_scanner(beams[i], parameters.data()) / kVoxel_m;
    const auto index = [&](int axis) { return static_cast<int>(std::floor(p[axis])); };
    voxels.push_back({index(0), index(1), index(2)});
  }
  std::ranges::sort(voxels);
  return voxels.size() - std::ranges::unique(voxels).size();
}

}  // namespace

double side_difference(std::span<const MirrorBeam> beams, const ParameterVector& parameters) {
  double best_rad = 0.0;
  std::size_t fewest = occupied(beams, parameters);
  for (int step = -kSteps; step <= kSteps; ++step) {
    const double difference_rad = step * kStep_rad;
    ParameterVector tried = parameters;
    tried[kPhase0] -= difference_rad / 2.0;
    tried[kPhase1] += difference_rad / 2.0;
    const std::size_t count = occupied(beams, tried);
    if (count >= fewest) continue;
    fewest = count;
    best_rad = difference_rad;
  }
  return best_rad;
}

}  // namespace voxlist::calibration
