#include "tests/bench/ramps/slab_world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "voxlist/geometry/angle.h"
#include "voxlist/simulation/random.h"

namespace voxlist::bench {
namespace {

Eigen::Vector3d ray(int i, const RoundLaser& laser) {
  constexpr double kGoldenAngle = 2.0 * std::numbers::pi * (2.0 - std::numbers::phi);
  const int columns = laser.rings > 0 ? laser.rays / laser.rings : 1;
  const double turn =
      laser.rings > 0 ? 2.0 * std::numbers::pi * (i % columns) / columns : kGoldenAngle * i;
  const double up_rad =
      laser.rings_to_deg * kRadPerDeg * (2.0 * (i / columns) / std::max(1, laser.rings - 1) - 1.0);
  const double z = laser.rings > 0 ? std::sin(up_rad) : 1.0 - (2.0 * i + 1.0) / laser.rays;
  const double level = std::sqrt(1.0 - z * z);
  return {level * std::cos(turn), level * std::sin(turn), z};
}

}  // namespace

SlabWorld::SlabWorld(std::vector<Slab> slabs) {
  for (const Slab& slab : slabs) {
    const Pose3 T_slab_map = slab.T_map_slab.inverse();
    slabs_.push_back({T_slab_map.linear(), T_slab_map.translation(), slab.half_m});
  }
}

std::optional<double> SlabWorld::range_m(const Eigen::Vector3d& origin,
                                         const Eigen::Vector3d& direction) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Turned& slab : slabs_) {
    const Eigen::Array3d from = (slab.R_slab_map * origin + slab.t_slab_map).array(),
                         way = (slab.R_slab_map * direction).array(),
                         a = (-slab.half_m.array() - from) / way,
                         b = (slab.half_m.array() - from) / way;
    const double in = a.min(b).maxCoeff(), out = a.max(b).minCoeff();
    if (in <= out && in > 0.0) nearest = std::min(nearest, in);
  }
  return std::isfinite(nearest) ? std::optional(nearest) : std::nullopt;
}

double SlabWorld::ground_m(const Eigen::Vector3d& above) const {
  return above.z() - range_m(above, {1e-9, 1e-9, -1.0}).value_or(0.0);
}

Cloud SlabWorld::scan(const Pose3& T_map_base, const RoundLaser& laser, std::uint64_t seed) const {
  simulation::Random random(seed);
  const Eigen::Vector3d eye(0.0, 0.0, laser.height_m), eye_map = T_map_base * eye;
  Cloud cloud;
  for (int i = 0; i < laser.rays; ++i) {
    const Eigen::Vector3d way = ray(i, laser);
    const auto range = range_m(eye_map, T_map_base.linear() * way);
    if (!range || *range > laser.range_max_m) continue;
    const Eigen::Vector3d end = (*range + laser.range_sd_m * random.normal()) * way;
    cloud.points.push_back((eye + end).cast<float>());
  }
  cloud.origins.assign(cloud.points.size(), eye.cast<float>());
  return cloud;
}

}  // namespace voxlist::bench
