#include "services/voxlist/report/run/surface_distance.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace voxlist::desk {
namespace {

struct Step {
  Voxel by;
  double distance_m;
};

// All neighbours within the farthest distance, the nearest first.
std::vector<Step> steps(double resolution_m) {
  // Half a millimetre of slack: 0.02 m is one voxel, whatever its last bit.
  const double farthest_m = kNear_m.back() + 5e-4;
  const auto reach = static_cast<std::int32_t>(farthest_m / resolution_m);
  std::vector<Step> found;
  for (std::int32_t x = -reach; x <= reach; ++x)
    for (std::int32_t y = -reach; y <= reach; ++y)
      for (std::int32_t z = -reach; z <= reach; ++z) {
        const double distance_m = resolution_m * std::sqrt(double(x * x + y * y + z * z));
        if (distance_m <= farthest_m) found.push_back({{x, y, z}, distance_m});
      }
  std::ranges::stable_sort(found, {}, &Step::distance_m);
  return found;
}

using Counts = std::array<std::int64_t, kNear_m.size()>;

void count(const Voxel& v, const VoxelMap& to, const std::vector<Step>& steps, Counts& counts) {
  for (const Step& step : steps) {
    if (!to.contains({v.x + step.by.x, v.y + step.by.y, v.z + step.by.z})) continue;
    for (std::size_t i = 0; i < kNear_m.size(); ++i)
      counts[i] += step.distance_m <= kNear_m[i] + 5e-4;
    return;
  }
}

}  // namespace

std::array<double, kNear_m.size()> shares_near(const VoxelMap& from, const VoxelMap& to) {
  const std::vector<Step> around = steps(from.resolution_m());
  tbb::enumerable_thread_specific<Counts> parts{Counts{}};
  tbb::parallel_for(std::size_t{0}, from.block_count(), [&](std::size_t block) {
    Counts& counts = parts.local();
    VoxelMap::visit_block(from.block_position(block), from.block(block),
                          [&](const Voxel& v) { count(v, to, around, counts); });
  });
  std::array<double, kNear_m.size()> shares{};
  for (const Counts& counts : parts)
    for (std::size_t i = 0; i < shares.size(); ++i)
      shares[i] += static_cast<double>(counts[i]) / std::max(1.0, static_cast<double>(from.size()));
  return shares;
}

}  // namespace voxlist::desk
