#include "tests/bench/grids/true_grid.h"

#include <algorithm>

namespace voxlist::bench {
namespace {

using planning::kColumn_m;

constexpr int kPoints = 8;  // along a cell's edge
constexpr double kMargin_m = 0.02;
// As low as what hangs may be.
constexpr double kPassage_m = 0.2;

struct Heights {
  double low_m, high_m;
};

bool is_within(const simulation::Box& box, const Heights& heights) {
  return box.top_m() > heights.low_m && box.bottom_m() < heights.high_m;
}

// How far a cell's points are from a box's footprint: the nearest one's distance, and whether one
// is inside.
struct Meeting {
  bool is_inside = false;
  double nearest_m = 1e9;
};

// How far inside a box's footprint a point is.
double depth_m(const simulation::Box& box, const Eigen::Vector2d& point) {
  const Eigen::Vector3d local = box.to_local({point.x(), point.y(), box.centre_m.z()});
  return (box.half_m - local.cwiseAbs()).head<2>().minCoeff();
}

Meeting meet(const simulation::Box& box, const planning::Cell& cell) {
  Meeting meeting;
  for (int i = 0; i < kPoints * kPoints; ++i) {
    const Eigen::Vector2d point((cell.x + (i % kPoints + 0.5) / kPoints) * kColumn_m,
                                (cell.y + (i / kPoints + 0.5) / kPoints) * kColumn_m);
    const double away_m = box.distance_m(point);
    meeting.nearest_m = std::min(meeting.nearest_m, away_m);
    meeting.is_inside |= away_m <= 0.0 && depth_m(box, point) >= kMargin_m;
  }
  return meeting;
}

bool is_in_hole(const simulation::Building& building, const planning::Cell& cell) {
  const Eigen::Vector2d middle((cell.x + 0.5) * kColumn_m, (cell.y + 0.5) * kColumn_m);
  return std::ranges::any_of(building.holes, [&](const simulation::Rectangle& hole) {
    const Eigen::Array2d inside = (middle - hole.low).array().min((hole.high - middle).array());
    return (inside > kColumn_m / 2 + kMargin_m).all();
  });
}

}  // namespace

TrueCell true_cell(const simulation::Building& building, const planning::Cell& cell,
                   const planning::RobotProfile& robot) {
  const Heights body{robot.step_m, robot.clear_height_m()};
  bool stands = false, hangs = false, grazes = false;
  const Eigen::Vector2d middle((cell.x + 0.5) * kColumn_m, (cell.y + 0.5) * kColumn_m);
  for (const simulation::Box& box : building.solid.boxes()) {
    if (!is_within(box, body) || box.distance_m(middle) > 2.0 * kColumn_m) continue;
    const Meeting meeting = meet(box, cell);
    if (meeting.is_inside) (box.bottom_m() < kPassage_m ? stands : hangs) = true;
    grazes |= meeting.nearest_m < kMargin_m;
  }
  if (stands) return TrueCell::kObstacle;
  if (is_in_hole(building, cell)) return TrueCell::kHole;
  if (hangs) return TrueCell::kOverhang;
  const bool is_at_hole = std::ranges::any_of(
      building.holes, [&](const auto& hole) { return hole.distance_m(middle) < kColumn_m; });
  return grazes || is_at_hole ? TrueCell::kBorder : TrueCell::kFree;
}

}  // namespace voxlist::bench
