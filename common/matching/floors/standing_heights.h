#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "voxlist/voxels/occupancy_map.h"

namespace voxlist::matching {

/// Heights (m) of a map's floors, the largest floor first: surfaces with free space above them, on
/// which a robot may stand. Of ramps and stairs every 0.3 m or so; table tops are among them where
/// there are square metres of them. At most 16. About 20 ms for 600,000 voxels.
std::vector<double> standing_heights(const OccupancyMap& map);

/// The same of what lies within 3 m of a place, seen from above, and up to 30 m above and below it:
/// every few decimetres on a floor. About 0.3 ms a floor.
std::vector<double> standing_heights_about(const OccupancyMap& map, const Eigen::Vector3d& at);

/// The same of a robot that moves: looks again when it has moved by 0.5 m.
class StandingHeights {
 public:
  const std::vector<double>& about(const OccupancyMap& map, const Eigen::Vector3d& at);

  /// The map is another one.
  void clear() { *this = {}; }

 private:
  std::optional<Eigen::Vector3d> at_;
  std::vector<double> heights_m_;
};

}  // namespace voxlist::matching
