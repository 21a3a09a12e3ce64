#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "voxlist/matching/counting/coarse_sweep.h"
#include "voxlist/matching/counting/dilated_map.h"

namespace voxlist::matching {

/// Points of a scan, to be turned by every angle of a lattice. Angles come in groups of eight, and
/// a group in parts: part 0 is all of it, parts 1 and 2 are its halves, 3 to 6 its quarters, 7 to
/// 14 single angles; part p is halved into 2 p + 1 and 2 p + 2.
class TurnedPoints {
 public:
  /// Angles of a group.
  static constexpr std::int32_t kGroup = CoarseMap::kFactor;
  static constexpr std::int32_t kParts = 2 * kGroup - 1;

  /// The first part that is a single angle.
  static constexpr std::int32_t kFirstSingle = kGroup - 1;

  /// Points (base, m) outside the map's layers are left out: they hit nothing.
  TurnedPoints(const DilatedMap& map, std::span<const Eigen::Vector3f> points);

  /// Points that are left.
  std::size_t size() const { return points_.size(); }

  /// Angles that move no point by more than a cell from one to the next; whole groups.
  std::int32_t angles() const { return groups_ * kGroup; }
  std::int32_t groups() const { return groups_; }
  double yaw_rad(std::int32_t angle) const;

  /// The coarse cells of the points of a group, as bits for coarse_sweep(). Safe from several
  /// threads.
  std::vector<std::int64_t> coarse_cells(std::int32_t group, const CoarseMap& map) const;

  /// Where the points' windows lie at translation (0, 0), on maps blurred as far as each point
  /// moves within the part: a window tells at which translations the point may hit for one of the
  /// part's angles, and exactly so for a single one. Use from one thread.
  std::span<const DilatedMap::Place> places(std::int32_t group, std::int32_t part);

 private:
  struct Cell {
    std::int32_t x, y;
  };
  using Cells = std::array<Cell, kGroup>;

  // Turns a point by a group's angles.
  class Turn;

  void make_places(std::int32_t group);

  const DilatedMap& map_;
  std::vector<Eigen::Vector2f> points_;
  std::vector<std::int32_t> layers_;
  std::int32_t groups_;
  std::vector<std::vector<DilatedMap::Place>> places_;  // by group; by part and point
};

}  // namespace voxlist::matching
