#include "services/voxlist/report/paper/real_scans.h"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/measured/chance.h"
#include "services/voxlist/report/measured/filter_trace.h"
#include "services/voxlist/report/measured/places.h"
#include "services/voxlist/report/measured/statistics.h"
#include "voxlist/io/files/file.h"
#include "voxlist/io/scans/scan_folder.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::desk {
namespace {

constexpr std::size_t kMapScans = 20;  // paper, section III
constexpr int kMostQueries = 12;
constexpr int kFilterQueries = 2;  // seconds each, where a laser reaches far
// Poses that may be off by decimetres: what the folder's own truth is good for.
constexpr double kRight_m = 0.3, kRight_rad = 3.0 / 57.29577951308232;

struct Recorded {
  std::string name;
  OccupancyMap map;
  std::vector<PlacedScan> queries;
};

Recorded read(const std::filesystem::path& folder, int most) {
  const io::ScanFolder scans(folder);
  if (!scans.poses())
    throw io::FileError(folder, "has no poses.csv: a map at known poses is needed");
  Recorded recorded{folder.filename().string(), {}, {}};
  const std::size_t map_step = std::max<std::size_t>(1, scans.size() / kMapScans);
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const auto truth = scans.truth(i);
    if (!truth) continue;
    if (i % map_step == 0)
      add_scan(scans.read(i), *truth, 100.0, recorded.map);
    else if (i % map_step == map_step / 2)
      others.push_back(i);
  }
  const std::size_t step = std::max<std::size_t>(1, others.size() / static_cast<std::size_t>(most));
  for (std::size_t k = 0; k < others.size() && std::ssize(recorded.queries) < most; k += step)
    recorded.queries.push_back({scans.read(others[k]), to_pose2(*scans.truth(others[k]))});
  if (recorded.map.empty() || recorded.queries.empty())
    throw io::FileError(folder, "has too few scans with poses for a map and for others to find");
  // The last first: where a drive begins is often the map's origin, which every lattice has.
  std::ranges::reverse(recorded.queries);
  return recorded;
}

bool right(const Pose2& found, const Pose2& truth) {
  return distance_m(found, truth) < kRight_m && turn_rad(found, truth) < kRight_rad;
}

std::string picture(const Recorded& recorded, const PlacedScan& query, const Pose2& found) {
  Chart chart({"map of 20 scans, and one scan where it was found",
               {"x (m)"},
               {"y (m)"},
               520.0,
               460.0,
               true});
  std::vector<Eigen::Vector2d> walls;
  for (const Cell& cell : plan_of(recorded.map.occupied, 0.2))
    walls.push_back(cell.low + Eigen::Vector2d::Constant(0.1));
  return chart.dots("map, 0.5 to 1.9 m high", Ink::kMap, walls, 1.6)
      .dots("scan", Ink::kOurs, plan_of(query.cloud, found), 1.4)
      .crosses("its pose in poses.csv", Ink::kPaper, {{query.truth.x_m, query.truth.y_m}})
      .svg();
}

std::string histogram_of(const ChanceLevel& level) {
  const std::vector<Bar> bars = histogram(level.overlaps, 40);
  const double width = bars.front().high - bars.front().low;
  const Moments formula{matching::overlap_mean(level.model),
                        std::sqrt(matching::overlap_variance(level.model))};
  const double high = std::max(bars.back().high, formula.mean + 4.0 * formula.sd);
  double top = 0.0;
  for (const Bar& bar : bars) top = std::max(top, bar.height);
  return Chart({fmt::format("{:.2f} m", level.resolution_m),
                {"overlap (voxels)", Range{0.0, high}},
                {"share of the poses", Range{0.0, 1.6 * top}},
                300.0,
                230.0})
      .bars("wrong poses", Ink::kOurs, bars)
      .line("section IV", Ink::kPaper, normal_curve(formula, 0.0, high, width))
      .svg();
}

// What the engine says of each scan by itself.
struct EngineAnswers {
  std::vector<double> off_m;  // of those at the right place
  int claimed = 0, wrong = 0;
  Pose2 first;  // the first scan's, or its truth where it is not at the right place
};

EngineAnswers ask_engine(const Recorded& recorded) {
  matching::LocaliserConfig config;
  config.threads = 1;
  matching::Localiser localiser(recorded.map, config);
  EngineAnswers answers;
  answers.first = recorded.queries.front().truth;
  for (const PlacedScan& query : recorded.queries) {
    const matching::Localisation found = localiser.locate(query.cloud);
    const bool is_right =
        !found.modes.empty() && right(found.modes.front().T_map_base, query.truth);
    answers.claimed += found.tracking();
    answers.wrong += found.tracking() && !is_right;
    if (!is_right) continue;
    answers.off_m.push_back(distance_m(found.modes.front().T_map_base, query.truth));
    if (&query == &recorded.queries.front()) answers.first = found.modes.front().T_map_base;
  }
  return answers;
}

// The filter's way down the levels, for the first few scans.
std::vector<std::vector<TraceLevel>> ask_filter(const Recorded& recorded) {
  std::vector<std::vector<TraceLevel>> traces(
      std::min<std::size_t>(kFilterQueries, recorded.queries.size()));
  const matching::ParticleFilter filter(recorded.map.occupied);
  tbb::parallel_for(std::size_t{0}, traces.size(), [&](std::size_t i) {
    traces[i] =
        trace(filter, recorded.queries[i].cloud.points, matching::whole_map(recorded.map.occupied));
  });
  return traces;
}

Table table_by_level(const Recorded& recorded, const std::vector<std::vector<TraceLevel>>& traces) {
  Table table{fmt::format("The filter, by the level at which it stops ({} scans)", traces.size()),
              {"eps (m)", "right", "error of the first scan", "particles of the first scan",
               "CPU s of the first scan"},
              {}};
  for (std::size_t k = 0; k < traces.front().size(); ++k) {
    int count = 0;
    for (std::size_t i = 0; i < traces.size(); ++i)
      count += right(traces[i][k].best, recorded.queries[i].truth);
    const TraceLevel& first = traces.front()[k];
    table.rows.push_back({fmt::format("{:.2f}", first.lattice.resolution_m()),
                          fmt::format("{} of {}", count, traces.size()),
                          metres(distance_m(first.best, recorded.queries.front().truth)),
                          fmt::format("{}", first.weighed),
                          timed(fmt::format("{:.2f}", first.seconds))});
  }
  return table;
}

Table table_of_chance(const std::vector<ChanceLevel>& levels) {
  Table table{
      "Overlaps at wrong poses",
      {"eps (m)", "mean, eq. 4", "measured", "sd, eq. 5", "measured", "D from its own normal"},
      {}};
  for (const ChanceLevel& level : levels) {
    const Moments own = moments(level.overlaps);
    table.rows.push_back({fmt::format("{:.2f}", level.resolution_m),
                          fmt::format("{:.1f}", matching::overlap_mean(level.model)),
                          fmt::format("{:.1f}", own.mean),
                          fmt::format("{:.2f}", std::sqrt(matching::overlap_variance(level.model))),
                          fmt::format("{:.2f}", own.sd),
                          fmt::format("{:.3f}", distance_from_normal(level.overlaps, own))});
  }
  return table;
}

}  // namespace

Entry real_scans(const std::filesystem::path& folder, const Scene& scene) {
  const Recorded recorded = read(folder, std::min(kMostQueries, scene.scale().queries));
  const EngineAnswers engine = ask_engine(recorded);
  const auto levels = wrong_overlaps(recorded.map.occupied, recorded.queries.front(),
                                     scene.scale().wrong_poses, scene.seed());
  Entry entry;
  entry.paper =
      "As in Fig. 4, Fig. 6 and section V: +-0.02 m, normal down to 0.64 m, best at 0.08 m.";
  entry.setup = fmt::format(
      "Folder {}: a map of {} scans at poses.csv, and {} other scans, each found by itself. Right: "
      "within 0.3 m and 3 deg of poses.csv, which has errors of its own.",
      recorded.name, kMapScans, recorded.queries.size());
  entry.comparisons = {
      {"engine: right place", "not said",
       fmt::format("{} of {}", engine.off_m.size(), recorded.queries.size())},
      {"engine: median error of those", "0.02 m", millimetres(percentile(engine.off_m, 0.5))},
      {"claimed, and wrong of them", "not said",
       fmt::format("{}, {}", engine.claimed, engine.wrong)}};
  entry.panels = {{picture(recorded, recorded.queries.front(), engine.first)}};
  for (const ChanceLevel& level : levels) entry.panels.push_back({histogram_of(level)});
  entry.tables = {table_by_level(recorded, ask_filter(recorded)), table_of_chance(levels)};
  entry.differs =
      "Another laser and a hall instead of rooms: it sees farther, so equation 1 asks for more "
      "headings, and the filter weighs many more particles. Section V and Figs. 7 and 8 "
      "need a scanner that stands in a room whose size is known, which a folder does not tell.";
  entry.seeds = fmt::format("wrong poses {}", scene.seed());
  return entry;
}

}  // namespace voxlist::desk
