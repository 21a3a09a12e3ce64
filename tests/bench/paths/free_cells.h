#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace voxlist::bench {

/// The cells of a floor plan that are known to be free: what planners are held against.
class FreeCells {
 public:
  /// Asks `is_free` of the middle of each cell between two corners.
  FreeCells(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell_m,
            const std::function<bool(const Eigen::Vector2d&)>& is_free);

  /// Whether a round robot reaches into free cells alone.
  bool hold(const Eigen::Vector2d& middle, double radius_m) const;

  /// Whether a robot that moves from cell to cell gets there: a search of all cells.
  bool lead(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double radius_m) const;

 private:
  using Index = Eigen::Vector2i;

  bool contain(const Index& cell) const;
  Index cell_at(const Eigen::Vector2d& point) const;
  Eigen::Vector2d middle_of(const Index& cell) const;
  std::size_t number_of(const Index& cell) const;

  Eigen::Vector2d low_;
  double cell_m_;
  Index size_;
  std::vector<bool> free_;
};

}  // namespace voxlist::bench
