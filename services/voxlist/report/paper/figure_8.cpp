#include <fmt/core.h>

#include <algorithm>

#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/measured/scanner_room.h"
#include "services/voxlist/report/paper/figures.h"

namespace voxlist::desk {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::vector<Vector3d> in_room(const Cloud& cloud) {
  std::vector<Vector3d> points;
  for (const Eigen::Vector3f& point : cloud.points)
    points.push_back(kStand * Vector3d(point.cast<double>()));
  return points;
}

std::string side(const std::string& title, const std::vector<Vector3d>& points, int across,
                 double half_m) {
  std::vector<Vector2d> seen;
  for (const Vector3d& p : points) seen.emplace_back(p[across], p.z());
  std::vector<double> metres;
  for (int m = -4; m <= 4; ++m) metres.push_back(m);
  const double top = 2.0 * kRoomHalf_m.z();
  return Chart({title,
                {across == 0 ? "x (m), a grid cell is 1 m" : "y (m), a grid cell is 1 m",
                 Range{-half_m - 0.4, half_m + 0.4}, Scale::kLinear, metres},
                {"height (m)", Range{-0.4, top + 0.4}, Scale::kLinear, metres},
                across == 0 ? 400.0 : 620.0,
                360.0,
                true})
      .line("the room, 3 x 6 x 2.75 m", Ink::kPaper,
            {{-half_m, 0.0}, {half_m, 0.0}, {half_m, top}, {-half_m, top}, {-half_m, 0.0}})
      .dots("points of one scan", Ink::kOurs, seen, 1.8)
      .svg();
}

// From the lowest to the highest of nearly all points.
double extent(const std::vector<Vector3d>& points, int axis) {
  std::vector<double> values;
  for (const Vector3d& p : points) values.push_back(p[axis]);
  std::ranges::sort(values);
  return values[values.size() * 199 / 200] - values[values.size() / 200];
}

}  // namespace

Entry figure_8(const Scene&) {
  const ScannerRecording recording{simulation::MirrorScannerConfig()};
  const std::vector<Vector3d> points = in_room(recording.clouds(as_drawn()).back());
  Entry entry;
  entry.paper =
      "\"Side view of a single scan for a room of dimensions 3 by 6 by 2.75. The grid cells are 1 "
      "m.\"";
  entry.setup =
      fmt::format("One simulated scan of {} points of such a room, empty.", points.size());
  entry.comparisons = {{"width", "3 m", fmt::format("{:.2f} m", extent(points, 0)),
                        "half a per cent of the points left out at each end"},
                       {"length", "6 m", fmt::format("{:.2f} m", extent(points, 1))},
                       {"height", "2.75 m", fmt::format("{:.2f} m", extent(points, 2))}};
  entry.panels = {{side("from the side, along the room", points, 1, kRoomHalf_m.y())},
                  {side("from its end", points, 0, kRoomHalf_m.x())}};
  entry.differs =
      "The paper puts the ceiling of the same room at 3.2 m above the scanner in section V, and at "
      "2.75 m above the floor in Fig. 8: both cannot be. The floor round the robot is hidden by "
      "the "
      "robot itself, the ceiling above it by the blind wedge of the mirror.";
  entry.seeds = "noise of the laser 8; --seed does not change it";
  return entry;
}

}  // namespace voxlist::desk
