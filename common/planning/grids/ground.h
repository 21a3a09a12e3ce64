#pragma once

#include <cstdint>
#include <vector>

#include "voxlist/planning/grids/flood.h"
#include "voxlist/planning/grids/floor_columns.h"
#include "voxlist/planning/grids/floor_steps.h"

namespace voxlist::planning {

/// How the floor at a cell is known.
enum class Footing : std::uint8_t {
  kNone,     ///< no floor is near
  kNear,     ///< not known; there is a floor within kReach_m, whose height is told
  kBridged,  ///< not hit, but a ray passed close above it, and it was hit on either side
  kSeen,     ///< hit, and reached by no more than steps from where the robot drove
  kDriven,   ///< the robot was there
};

/// A flood's own changes change the ground no farther away than this (cells).
inline constexpr std::int32_t kGroundMargin =
    static_cast<std::int32_t>(kReach_m / kColumn_m) + kBridge + 1;

/// The ground about what a flood has reached, in a part of the floor plan: gaps between rays are
/// bridged, and a floor's height is told beyond its edge.
class Ground {
 public:
  /// Costs some 50 ns a column. What is outside the flood's box is left out.
  Ground(const FloorColumns& columns, const Flood& flood, const CellBox& box);

  const CellBox& box() const { return box_; }

  Footing footing(const Cell& cell) const { return footing_[whole_.index(cell)]; }

  /// The floor's height (m); where it is not known, that of the nearest floor's edge, and of
  /// several as near the highest. Precondition: footing is not kNone.
  float height_m(const Cell& cell) const { return height_m_[whole_.index(cell)]; }

 private:
  void put(const Cell& cell, Footing footing, float height_m);
  void take(const Flood& flood);
  void bridge(const FloorSteps& steps, const Flood& flood);
  void reach_on();

  CellBox box_, whole_;  // with the margin that tells what is in the box
  std::vector<Footing> footing_;
  std::vector<float> height_m_;
};

}  // namespace voxlist::planning
