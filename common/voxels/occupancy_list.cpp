#include "voxlist/voxels/occupancy_list.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace voxlist {

OccupancyList OccupancyList::from_points(std::span<const Eigen::Vector3f> points,
                                         double resolution_m) {
  std::vector<Voxel> voxels;
  voxels.reserve(points.size());
  for (const auto& p : points) {
    if (in_lattice(p, resolution_m)) voxels.push_back(voxel_at(p, resolution_m));
  }
  return {std::move(voxels), resolution_m};
}

OccupancyList::OccupancyList(std::vector<Voxel> voxels, double resolution_m)
    : resolution_m_(resolution_m), voxels_(std::move(voxels)) {
  std::sort(voxels_.begin(), voxels_.end());
  voxels_.erase(std::unique(voxels_.begin(), voxels_.end()), voxels_.end());
}

const OccupancyList& OccupancyList::down_sampled(int factor) const {
  if (factor < 1)
    throw std::invalid_argument(fmt::format("OccupancyList: down-sample factor {} < 1", factor));
  if (factor == 1) return *this;
  auto& cached = down_sample_cache_[factor];
  if (!cached) {
    std::vector<Voxel> coarse;
    coarse.reserve(voxels_.size());
    for (const Voxel& v : voxels_) {
      coarse.push_back({floor_div(v.x, factor), floor_div(v.y, factor), floor_div(v.z, factor)});
    }
    cached = std::make_shared<const OccupancyList>(std::move(coarse), resolution_m_ * factor);
  }
  return *cached;
}

}  // namespace voxlist
