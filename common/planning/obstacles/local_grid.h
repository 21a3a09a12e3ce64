#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace voxlist::planning {

/// Squares round the base, on its axes: where each is. What they hold is in vectors of size(),
/// ordered by x, then y.
class LocalGrid {
 public:
  /// What is round a cell: steps to other cells, and how far those are (m).
  struct Neighbour {
    int columns, rows;
    float distance_m;
  };

  /// `half_m`: from base to the grid's edge.
  LocalGrid(double half_m, double cell_m);

  std::size_t size() const {
    return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_);
  }
  float cell_m() const { return cell_m_; }

  /// The cell at a place; nothing outside the grid.
  std::optional<std::size_t> at(const Eigen::Vector2f& place) const {
    const int column = floor_of(place.x() / cell_m_) + half_;
    const int row = floor_of(place.y() / cell_m_) + half_;
    if (!is_inside(column, row)) return std::nullopt;
    return index(column, row);
  }

  Eigen::Vector2f centre(std::size_t cell) const;

  /// Distance of the centre from base (m).
  float range_m(std::size_t cell) const { return ranges_m_[cell]; }

  /// The neighbours whose centres are within a radius, the cell itself left out, nearest first.
  std::vector<Neighbour> disc(double radius_m) const;

  /// Calls visit(other cell, distance in m) for each neighbour that is in the grid, until it
  /// returns false.
  template <class Visit>
  void while_around(std::size_t cell, const std::vector<Neighbour>& disc,
                    const Visit& visit) const {
    const int column = static_cast<int>(cell) / side_, row = static_cast<int>(cell) % side_;
    for (const Neighbour& n : disc)
      if (is_inside(column + n.columns, row + n.rows) &&
          !visit(index(column + n.columns, row + n.rows), n.distance_m))
        return;
  }

  /// The same for all neighbours.
  template <class Visit>
  void around(std::size_t cell, const std::vector<Neighbour>& disc, const Visit& visit) const {
    while_around(cell, disc, [&visit](std::size_t other, float distance_m) {
      visit(other, distance_m);
      return true;
    });
  }

 private:
  // std::floor is a call on processors of 2003, which is what Debian compiles for. What no cell
  // counts to is outside.
  static int floor_of(float value) {
    constexpr float kOutside = 1e6F;
    if (!(value > -kOutside && value < kOutside)) return static_cast<int>(kOutside);
    const int toward_zero = static_cast<int>(value);
    return toward_zero - (value < static_cast<float>(toward_zero) ? 1 : 0);
  }

  bool is_inside(int column, int row) const {
    return column >= 0 && column < side_ && row >= 0 && row < side_;
  }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(column) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(row);
  }

  float cell_m_;
  int half_, side_;
  std::vector<float> ranges_m_;
};

}  // namespace voxlist::planning
