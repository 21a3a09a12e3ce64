#include <fmt/core.h>

#include <set>

#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/measured/places.h"
#include "services/voxlist/report/paper/figures.h"
#include "voxlist/voxels/occupancy_list.h"

namespace voxlist::desk {
namespace {

using Eigen::Vector2d;

constexpr double kShown_m = 1.28;  // edge of the piece that is shown

// The lower left corner of the piece of the floor plan with most points.
Vector2d busiest(const std::vector<Vector2d>& points) {
  Vector2d best = Vector2d::Zero();
  std::size_t most = 0;
  for (std::size_t i = 0; i < points.size(); i += 25) {
    const Vector2d low = ((points[i].array() / 0.16).floor() - 4.0) * 0.16;
    std::size_t count = 0;
    for (const Vector2d& p : points)
      count += ((p - low).array() >= 0.0).all() && ((p - low).array() < kShown_m).all();
    if (count > most) {
      most = count;
      best = low;
    }
  }
  return best;
}

std::vector<Vector2d> occupied(const std::vector<Vector2d>& points, double edge) {
  std::set<std::pair<int, int>> cells;
  for (const Vector2d& p : points)
    cells.emplace(static_cast<int>(std::floor(p.x() / edge)),
                  static_cast<int>(std::floor(p.y() / edge)));
  std::vector<Vector2d> lows;
  for (const auto& [x, y] : cells) lows.push_back(Vector2d(x, y) * edge);
  return lows;
}

std::string picture(const std::vector<Vector2d>& points) {
  const Vector2d low = busiest(points);
  Chart chart({"points of a scan, 0.5 to 1.9 m high, and the voxels that hold them",
               {"x (m)", Range{low.x(), low.x() + kShown_m}},
               {"y (m)", Range{low.y(), low.y() + kShown_m}},
               480.0,
               500.0,
               true});
  std::vector<Cell> fine;
  for (const Vector2d& cell : occupied(points, 0.08)) fine.push_back({cell, 0.3});
  return chart.cells("0.08 m", Ink::kOurs, fine, 0.08)
      .frames("0.16 m", Ink::kPaper, occupied(points, 0.16), 0.16)
      .crosses("points", Ink::kThird, points)
      .svg();
}

}  // namespace

Entry figure_5(const Scene& scene) {
  const PlacedScan query = scene.queries(1).front();
  const OccupancyList list = OccupancyList::from_points(query.cloud.points);
  Table table{"One scan and the map of 20 scans at each resolution (Algorithm 2)",
              {"eps (m)", "voxels of the scan", "points a voxel", "voxels of the map"},
              {}};
  for (int factor = 1; factor <= 64; factor *= 2) {
    const auto voxels = static_cast<double>(list.down_sampled(factor).size());
    table.rows.push_back(
        {fmt::format("{:.2f}", kFinestResolution_m * factor), fmt::format("{:.0f}", voxels),
         fmt::format("{:.1f}", static_cast<double>(query.cloud.points.size()) / voxels),
         fmt::format("{}", coarser(scene.map().occupied, factor).size())});
  }
  Entry entry;
  entry.paper =
      "Points (crosses) become the occupied voxels of a lattice; two resolutions are shown. The "
      "finest is 0.02 m, \"the limit of the accuracy of the 3D laser scanner\".";
  entry.setup = fmt::format("One scan of {} points.", query.cloud.points.size());
  entry.comparisons = {{"finest voxels", "0.02 m", fmt::format("{:.2f} m", kFinestResolution_m)},
                       {"down-sampling", "Math.round(v / f)", "floor(v / f)",
                        "round leans by half a voxel; voxels nest without"}};
  entry.panels = {{picture(plan_of(query.cloud, {}))}};
  entry.tables = {table};
  entry.differs =
      "The lattice is the paper's moved by half a voxel, so that eight voxels are one of the next "
      "level exactly.";
  return entry;
}

}  // namespace voxlist::desk
