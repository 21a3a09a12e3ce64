#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "matching/coarse_sweep.h"
#include "matching/tolerant_map.h"

namespace voxlist {

/// Points of a scan, to be turned by every angle of a lattice.
class TurnedPoints {
 public:
  /// Angles of a node.
  static constexpr std::int32_t kGroup = CoarseMap::kFactor;

  /// Points (base, m) outside the map's layers are left out: they hit nothing.
  TurnedPoints(const TolerantMap& map, std::span<const Eigen::Vector3f> points);

  /// Points that are left.
  std::size_t size() const { return points_.size(); }

  /// Angles that move no point by more than a cell from one to the next; whole groups.
  std::int32_t angles() const { return groups_ * kGroup; }
  std::int32_t groups() const { return groups_; }
  double yaw_rad(std::int32_t angle) const;

  /// Turns all points by the angles of a group. Groups may be turned by different threads.
  void turn(std::int32_t group);

  /// The points of a group in coarse cells. Only after turn().
  std::vector<CoarseCell> coarse_cells(std::int32_t group, const CoarseMap& map) const;

  /// The window of point i at an angle, moved by (x, y). Only after turn().
  std::uint64_t window(std::int32_t angle, std::size_t i, std::int32_t x, std::int32_t y) const {
    const Cell& cell = cells_[index(angle, i)];
    return map_.window_anywhere(cell.x + x, cell.y + y, layers_[i]);
  }

  /// Whether all points' windows lie within the map at an angle and translation.
  bool inside(std::int32_t angle, std::int32_t x, std::int32_t y) const {
    const Box& box = boxes_[static_cast<std::size_t>(angle)];
    return map_.holds(box.low.x + x, box.low.y + y) && map_.holds(box.high.x + x, box.high.y + y);
  }

  /// Places of the points' windows at an angle: TolerantMap::place(x, y, 0) is to be added.
  const std::int32_t* places(std::int32_t angle) const { return &places_[index(angle, 0)]; }

 private:
  struct Cell {
    std::int16_t x, y;
  };
  struct Box {
    Cell low, high;
  };

  std::size_t index(std::int32_t angle, std::size_t i) const {
    return points_.size() * static_cast<std::size_t>(angle) + i;
  }

  const TolerantMap& map_;
  std::vector<Eigen::Vector2f> points_;
  std::vector<std::int32_t> layers_;
  std::int32_t groups_;
  std::vector<Cell> cells_;           // relative to the base's own, by angle and point
  std::vector<std::int32_t> places_;  // the same, as places
  std::vector<Box> boxes_;            // by angle
};

}  // namespace voxlist
