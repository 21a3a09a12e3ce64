#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/measured/places.h"
#include "services/voxlist/report/run/folder.h"

namespace voxlist::desk {
namespace {

double way_m(const std::vector<StampedPose3>& trajectory) {
  double way = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    way += (trajectory[i].pose.translation() - trajectory[i - 1].pose.translation()).norm();
  return way;
}

// Ground over which rays passed or hit (m^2).
double seen_m2(const OccupancyMap& map) {
  std::set<std::pair<int, int>> columns;
  map.passed.for_each_voxel([&](const Voxel& v) { columns.emplace(v.x, v.y); });
  const int ratio = static_cast<int>(kPassedResolution_m / map.occupied.resolution_m() + 0.5);
  map.occupied.for_each_voxel(
      [&](const Voxel& v) { columns.emplace(floor_div(v.x, ratio), floor_div(v.y, ratio)); });
  return static_cast<double>(columns.size()) * kPassedResolution_m * kPassedResolution_m;
}

Table counters(const Summary& summary) {
  Table table{"summary.json", {"", "value"}, {}};
  for (const auto& [key, value] : summary.items()) {
    const bool by_clock = key == "elapsed_seconds" || key == "real_time_factor";
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    table.rows.push_back({key, by_clock ? timed(text) : CellText(text)});
  }
  return table;
}

std::string plan(const MapFolder& folder) {
  std::vector<Eigen::Vector2d> walls, path;
  double low = 1e9;
  for (const StampedPose3& pose : folder.trajectory) {
    path.emplace_back(pose.pose.translation().head<2>());
    low = std::min(low, pose.pose.translation().z());
  }
  for (const Cell& cell : plan_of(folder.map.occupied, 0.16, low + 0.5, low + 1.9))
    walls.push_back(cell.low + Eigen::Vector2d::Constant(0.08));
  return Chart({"the map, and the way through it", {"x (m)"}, {"y (m)"}, 900.0, 560.0, true})
      .dots("occupied, 0.5 to 1.9 m above the lowest pose", Ink::kMap, walls, 2.0)
      .line("trajectory", Ink::kOurs, path)
      .svg();
}

}  // namespace

Entry run_summary(const MapFolder& folder) {
  Entry entry{"run", "What the run came to"};
  entry.panels = {{plan(folder)}};
  Table covers{"What the map covers", {"", "value"}, {}};
  covers.rows = {
      {"scans with a place", fmt::format("{}", folder.trajectory.size())},
      {"keyframes", fmt::format("{}", folder.keyframes.size())},
      {"way (m)", fmt::format("{:.1f}", way_m(folder.trajectory))},
      {"ground that was seen (m2)", fmt::format("{:.1f}", seen_m2(folder.map))},
      {"occupied voxels of 0.02 m", fmt::format("{}", folder.map.occupied.size())},
      {"space that rays went through (m3)",
       fmt::format("{:.1f}", static_cast<double>(folder.map.passed.size()) * kPassedResolution_m *
                                 kPassedResolution_m * kPassedResolution_m)}};
  entry.tables = {covers};
  if (folder.summary)
    entry.tables.push_back(counters(*folder.summary));
  else
    entry.differs = "There is no summary.json that can be read: voxlist rebuild makes it anew.";
  return entry;
}

}  // namespace voxlist::desk
