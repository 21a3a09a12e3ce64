#pragma once

#include <vector>

#include "voxlist/geometry/cloud.h"

namespace voxlist::planning {

/// What its own scan line says of a point.
struct LineDrop {
  float below_m = 0.0F;     ///< so far below the line's floor beside it; 0: it is not
  bool is_between = false;  ///< floor on both sides; otherwise on one
};

/// Finds the points of each line of a cloud that lie below the floor beside them: at least three
/// beams of one line between floor on both sides, as in a hole, or the first beams beyond an edge,
/// as over a kerb that the line crosses. The beams of a line are some milliseconds apart, so
/// neither the robot's rocking nor a ramp that it comes upon looks like this, and a few centimetres
/// of a hole's far wall tell it. Whether what is beside them is floor, and not a table, is for
/// others to judge. Points of beams that follow each other must be neighbours in the cloud; of
/// clouds in another order nothing is found. Heights are those of base. Cost: linear.
std::vector<LineDrop> find_line_drops(const Cloud& cloud_base);

}  // namespace voxlist::planning
