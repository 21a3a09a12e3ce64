#include "voxlist/planning/obstacles/local_grid.h"

#include <algorithm>
#include <cmath>

namespace voxlist::planning {

LocalGrid::LocalGrid(double half_m, double cell_m)
    : cell_m_(static_cast<float>(cell_m)),
      half_(static_cast<int>(std::ceil(half_m / cell_m))),
      side_(2 * half_),
      ranges_m_(size()) {
  for (std::size_t cell = 0; cell < size(); ++cell) ranges_m_[cell] = centre(cell).norm();
}

Eigen::Vector2f LocalGrid::centre(std::size_t cell) const {
  const int column = static_cast<int>(cell) / side_, row = static_cast<int>(cell) % side_;
  return {(static_cast<float>(column - half_) + 0.5F) * cell_m_,
          (static_cast<float>(row - half_) + 0.5F) * cell_m_};
}

std::vector<LocalGrid::Neighbour> LocalGrid::disc(double radius_m) const {
  const int reach = static_cast<int>(radius_m / static_cast<double>(cell_m_) + 1e-3);
  std::vector<Neighbour> disc;
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach; y <= reach; ++y) {
      const float cells = std::sqrt(static_cast<float>(x * x + y * y));
      if (cells > 0.0F && cells <= static_cast<float>(reach) + 0.5F)
        disc.push_back({x, y, cells * cell_m_});
    }
  std::ranges::stable_sort(disc, {}, &Neighbour::distance_m);
  return disc;
}

}  // namespace voxlist::planning
