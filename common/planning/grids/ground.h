#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "voxlist/planning/grids/driven.h"
#include "voxlist/planning/grids/floor_columns.h"

namespace voxlist::planning {

/// How the floor at a cell is known.
enum class Footing : std::uint8_t {
  kNone,     ///< no floor is near
  kNear,     ///< not known; there is a floor within kReach_m, whose height is told
  kBridged,  ///< not hit, but a ray passed close above it, and it was hit on either side
  kSeen,     ///< hit, and reached by no more than steps from where the robot drove
  kDriven,   ///< the robot was there
};

/// How far beyond its edge a floor's height is told (m).
inline constexpr double kReach_m = 2.0;

/// The ground that a robot can get to over steps of a height, from where one has driven: any number
/// of ramps and heights, one above each place of the floor plan. Where floors lie above each other
/// it is the one that fewer cells lead to.
class Ground {
 public:
  /// Floods the columns from the cells that were driven. Costs some 50 ns a column. Precondition:
  /// the columns have bounds.
  Ground(const FloorColumns& columns, const std::vector<DrivenCell>& driven, double step_m);

  const CellBox& box() const { return box_; }

  Footing footing(const Cell& cell) const { return footing_[box_.index(cell)]; }

  /// The floor's height (m); where it is not known, that of the nearest floor's edge, and of
  /// several as near the highest. Precondition: footing is not kNone.
  float height_m(const Cell& cell) const { return height_m_[box_.index(cell)]; }

 private:
  void put(const Cell& cell, Footing footing, float height_m);
  void start(const std::vector<DrivenCell>& driven);
  void flood();
  void step_to(const Cell& cell, float from_m);
  void bridge(const Cell& from, const Cell& way);
  bool is_gap(const Cell& cell, float height_m) const;
  bool is_passed_below(const Cell& cell, float height_m) const;
  std::optional<float> floor_at(const Cell& cell, float from_m) const;
  void reach_on();

  const FloorColumns& columns_;
  const float step_m_;
  CellBox box_;
  std::vector<Footing> footing_;
  std::vector<float> height_m_;
  std::vector<Cell> edge_;  // cells from which the flood goes on, in order
};

}  // namespace voxlist::planning
