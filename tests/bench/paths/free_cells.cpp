#include "tests/bench/paths/free_cells.h"

#include <algorithm>
#include <cmath>

namespace voxlist::bench {

FreeCells::FreeCells(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell_m,
                     const std::function<bool(const Eigen::Vector2d&)>& is_free)
    : low_(low),
      cell_m_(cell_m),
      size_(((high - low) / cell_m).array().ceil().cast<int>()),
      free_(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y())) {
  Index cell;
  for (cell.y() = 0; cell.y() < size_.y(); ++cell.y())
    for (cell.x() = 0; cell.x() < size_.x(); ++cell.x())
      free_[number_of(cell)] = is_free(middle_of(cell));
}

bool FreeCells::hold(const Eigen::Vector2d& middle, double radius_m) const {
  const Eigen::Vector2d reach(radius_m, radius_m);
  const Index low = cell_at(middle - reach), high = cell_at(middle + reach);
  Index cell;
  for (cell.y() = low.y(); cell.y() <= high.y(); ++cell.y())
    for (cell.x() = low.x(); cell.x() <= high.x(); ++cell.x()) {
      const Eigen::Array2d away = (middle_of(cell) - middle).array().abs() - cell_m_ / 2.0;
      const bool is_touched = away.max(0.0).matrix().norm() < radius_m;
      if (is_touched && !(contain(cell) && free_[number_of(cell)])) return false;
    }
  return true;
}

bool FreeCells::lead(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                     double radius_m) const {
  const Index goal = cell_at(to);
  std::vector<bool> seen(free_.size());
  std::vector<Index> open;
  const auto visit = [&](const Index& cell) {
    if (!contain(cell) || seen[number_of(cell)]) return;
    seen[number_of(cell)] = true;
    if (hold(middle_of(cell), radius_m)) open.push_back(cell);
  };
  visit(cell_at(from));
  while (!open.empty()) {
    const Index cell = open.back();
    if (cell == goal) return true;
    open.pop_back();
    for (const Index& step : {Index(1, 0), Index(-1, 0), Index(0, 1), Index(0, -1)})
      visit(cell + step);
  }
  return false;
}

bool FreeCells::contain(const Index& cell) const {
  return (cell.array() >= 0).all() && (cell.array() < size_.array()).all();
}

FreeCells::Index FreeCells::cell_at(const Eigen::Vector2d& point) const {
  return ((point - low_) / cell_m_).array().floor().cast<int>();
}

Eigen::Vector2d FreeCells::middle_of(const Index& cell) const {
  return low_ + cell_m_ * (cell.cast<double>().array() + 0.5).matrix();
}

std::size_t FreeCells::number_of(const Index& cell) const {
  return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(size_.x()) +
         static_cast<std::size_t>(cell.x());
}

}  // namespace voxlist::bench
