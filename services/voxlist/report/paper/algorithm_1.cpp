#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/measured/filter_trace.h"
#include "services/voxlist/report/measured/places.h"
#include "services/voxlist/report/paper/figures.h"

namespace voxlist::desk {
namespace {

using Eigen::Vector2d;

// Whether a kept particle is as near to the truth as this level's lattice can tell.
bool holds_truth(const TraceLevel& level, const Pose2& truth) {
  const double step_m = level.lattice.resolution_m();
  return std::ranges::any_of(level.kept, [&](const matching::WeightedKey& particle) {
    const Pose2 pose = matching::pose_at(level.lattice, particle.key);
    return distance_m(pose, truth) <= step_m &&
           turn_rad(pose, truth) <= level.lattice.heading_step_rad();
  });
}

std::string picture(const TraceLevel& level, const VoxelMap& map, const Pose2& truth) {
  const double step_m = level.lattice.resolution_m(), edge_m = std::max(step_m, 0.16),
               wall_m = 0.16;
  std::map<std::pair<int, int>, double> places;
  for (const auto& [key, weight] : level.kept) {
    double& there = places[{static_cast<int>(std::floor(key.ix * step_m / edge_m)),
                            static_cast<int>(std::floor(key.iy * step_m / edge_m))}];
    there = std::max(there, static_cast<double>(weight) / level.weighing.max_weight);
  }
  std::vector<Cell> cells;
  for (const auto& [place, share] : places)
    cells.push_back({Vector2d(place.first, place.second) * edge_m, (share - 0.8) / 0.2});
  Chart chart({fmt::format("{:.2f} m: {} of {} kept", step_m, level.kept.size(), level.weighed),
               {"x (m)", Range{-2.0, 10.0}},
               {"y (m)", Range{-5.0, 5.0}},
               352.0,
               340.0,
               true});
  chart.cells("walls", Ink::kMap, plan_of(map, wall_m), wall_m)
      .cells("kept", Ink::kOurs, cells, edge_m)
      .crosses("truth", Ink::kPaper, {{truth.x_m, truth.y_m}});
  return chart.svg();
}

}  // namespace

Entry algorithm_1(const Scene& scene) {
  const PlacedScan query = scene.queries(1).front();
  const matching::ParticleFilter filter(scene.map().occupied);
  const std::vector<TraceLevel> levels = trace(filter, query.cloud.points, scene.everywhere());
  Entry entry;
  entry.paper =
      "Uniform poses at the coarsest level; down-sample, count overlaps, remove those below 80 % "
      "of "
      "the mode, re-sample round the rest, at 2^6 to 2^0 times 0.02 m.";
  entry.setup =
      "One scan in the map of 20 scans at their true poses. Pictures: places that are kept, darker "
      "where their best heading has more weight.";
  entry.comparisons = {
      {"levels", "2^6 to 2^0", fmt::format("{}", levels.size()), "1.28 to 0.02 m"},
      {"spacing of the first poses", "1.24 m", "1.28 m", "the text's 1.24 is 64 x 0.02 = 1.28"},
      {"pruned below", "80 % of the mode", "80 % of w max", "as Algorithm 1 and the text say"}};
  Table table{"What each level did; headings by equation 1, with R the range of this scan",
              {"eps (m)", "headings", "particles", "kept", "w max", "scan turned", "look-ups",
               "best is off by", "truth among the kept", "CPU ms"},
              {}};
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const TraceLevel& level = levels[i];
    entry.panels.push_back({picture(level, scene.map().occupied, query.truth)});
    table.rows.push_back(
        {fmt::format("{:.2f}", level.lattice.resolution_m()),
         fmt::format("{}", level.lattice.headings()), fmt::format("{}", level.weighed),
         fmt::format("{}", level.kept.size()), fmt::format("{}", level.weighing.max_weight),
         fmt::format("{}", level.weighing.rotations), fmt::format("{}", level.weighing.look_ups),
         fmt::format("{}, {}", metres(distance_m(level.best, query.truth)),
                     in_degrees(turn_rad(level.best, query.truth))),
         holds_truth(level, query.truth) ? "yes" : "no",
         timed(fmt::format("{:.1f}", level.seconds * 1e3))});
  }
  entry.tables = {table};
  entry.differs =
      "Poses are whole numbers, so that equal ones are one; re-sampling moves by one step of the "
      "new "
      "level in x, y and heading (Algorithm 4 as printed turns by the old step, and headings would "
      "never get finer).";
  return entry;
}

}  // namespace voxlist::desk
