#include "voxlist/planning/grids/driven.h"

#include <algorithm>
#include <cmath>

namespace voxlist::planning {
namespace {

void add_disc(const Eigen::Vector3d& at, std::vector<DrivenCell>& cells) {
  const auto cell = [](double m) { return static_cast<std::int32_t>(std::floor(m / kColumn_m)); };
  for (std::int32_t y = cell(at.y() - kDriven_m); y <= cell(at.y() + kDriven_m); ++y)
    for (std::int32_t x = cell(at.x() - kDriven_m); x <= cell(at.x() + kDriven_m); ++x) {
      const Eigen::Vector2d centre = Eigen::Vector2d(x + 0.5, y + 0.5) * kColumn_m;
      if ((centre - at.head<2>()).norm() <= kDriven_m)
        cells.push_back({{x, y}, static_cast<float>(at.z())});
    }
}

}  // namespace

std::vector<DrivenCell> driven_cells(const std::vector<Eigen::Vector3d>& way) {
  std::vector<DrivenCell> cells;
  for (std::size_t i = 0; i < way.size(); ++i) {
    add_disc(way[i], cells);
    if (i == 0) continue;
    const Eigen::Vector3d step = way[i] - way[i - 1];
    if (step.norm() > kDrivenStep_m) continue;
    const int parts = 1 + static_cast<int>(step.norm() / kColumn_m);
    for (int k = 1; k < parts; ++k) add_disc(way[i - 1] + step * k / parts, cells);
  }
  return cells;
}

}  // namespace voxlist::planning
