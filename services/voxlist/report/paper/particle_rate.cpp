#include <fmt/core.h>

#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/measured/engine_search.h"
#include "services/voxlist/report/measured/filter_trace.h"
#include "services/voxlist/report/measured/places.h"
#include "services/voxlist/report/measured/statistics.h"
#include "services/voxlist/report/paper/figures.h"

namespace voxlist::desk {
namespace {

constexpr double kPaperRate = 10'000.0;
const std::vector<double> kResolutions{0.02, 0.04, 0.08, 0.16, 0.32, 0.64, 1.28};
constexpr int kMostScans = 10;  // clocks want an idle machine, and no threads beside them

struct Sum {
  double poses = 0.0, seconds = 0.0, look_ups = 0.0;

  double rate() const { return seconds > 0.0 ? poses / seconds : 0.0; }
};

std::vector<Sum> filter_rates(const Scene& scene, const std::vector<PlacedScan>& scans) {
  const matching::ParticleFilter filter(scene.map().occupied);
  std::vector<Sum> sums(filter.maps().size());
  for (const PlacedScan& scan : scans) {
    const auto levels = trace(filter, scan.cloud.points, scene.everywhere());
    for (std::size_t i = 0; i < levels.size(); ++i) {
      sums[i].poses += static_cast<double>(levels[i].weighed);
      sums[i].seconds += levels[i].seconds;
      sums[i].look_ups += static_cast<double>(levels[i].weighing.look_ups);
    }
  }
  return sums;
}

struct EngineRate {
  double resolution_m;
  Sum sum;
  double examined = 0.0;
  int certified = 0;
};

EngineRate engine_rate(const Scene& scene, const std::vector<PlacedScan>& scans,
                       double resolution_m) {
  const EngineAt engine(scene.map().occupied, resolution_m);
  EngineRate rate{resolution_m, {}};
  for (const PlacedScan& scan : scans) {
    const EngineSearch search = engine.search(scan.cloud);
    rate.sum.poses += search.found.lattice_poses;
    rate.sum.seconds += search.seconds;
    rate.examined += static_cast<double>(search.found.poses_examined);
    rate.certified += search.found.certified;
  }
  return rate;
}

}  // namespace

Entry particle_rate(const Scene& scene) {
  const auto scans = scene.queries(std::min(kMostScans, scene.scale().queries));
  const auto count = static_cast<double>(scans.size());
  const std::vector<Sum> filter = filter_rates(scene, scans);
  Sum all;
  Table levels{"The paper's filter, as it is here, by level (one thread; a scan, in the mean)",
               {"eps (m)", "particles", "scan voxels looked up for each", "CPU ms", "particles/s",
                "times the paper's 10,000"},
               {}};
  std::vector<Eigen::Vector2d> by_filter, by_engine;
  for (std::size_t i = 0; i < filter.size(); ++i) {
    const double resolution_m = 1.28 / static_cast<double>(1 << i);
    by_filter.emplace_back(resolution_m, filter[i].rate());
    all.poses += filter[i].poses;
    all.seconds += filter[i].seconds;
    levels.rows.push_back({fmt::format("{:.2f}", resolution_m),
                           fmt::format("{:.0f}", filter[i].poses / count),
                           fmt::format("{:.0f}", filter[i].look_ups / filter[i].poses),
                           timed(fmt::format("{:.1f}", 1e3 * filter[i].seconds / count)),
                           timed(fmt::format("{:.0f}", filter[i].rate())),
                           timed(fmt::format("{:.1f}", filter[i].rate() / kPaperRate))});
  }
  Table search{
      "The engine, which proves that no pose of the lattice overlaps more (one thread; a "
      "scan, in the mean)",
      {"lattice (m)", "poses of the lattice", "nodes and poses counted", "certified", "CPU ms",
       "poses decided/s", "times the paper's 10,000"},
      {}};
  double at_4_cm = 0.0;
  for (const double resolution_m : {0.32, 0.16, 0.08, 0.04}) {
    const EngineRate rate = engine_rate(scene, scans, resolution_m);
    by_engine.emplace_back(resolution_m, rate.sum.rate());
    at_4_cm = rate.sum.rate();
    search.rows.push_back({fmt::format("{:.2f}", resolution_m),
                           fmt::format("{:.3g}", rate.sum.poses / count),
                           fmt::format("{:.0f}", rate.examined / count),
                           fmt::format("{} of {}", rate.certified, scans.size()),
                           timed(fmt::format("{:.1f}", 1e3 * rate.sum.seconds / count)),
                           timed(fmt::format("{:.2g}", rate.sum.rate())),
                           timed(fmt::format("{:.2g}", rate.sum.rate() / kPaperRate))});
  }
  Entry entry;
  entry.paper =
      "\"In this manner an order of 10,000 particles per second can be assessed on a standard 2 "
      "GHz "
      "computer. The precise rate depends on the resolution and structure of the map and local "
      "occupancy lists.\"";
  entry.setup = fmt::format(
      "{} scans of some 5,600 points in the map of 20 scans, one after the other, CPU time of one "
      "thread. A level's time is that of re-sampling, counting and pruning.",
      scans.size());
  entry.comparisons = {
      {"filter, all levels", "10,000 /s", timed(fmt::format("{:.0f} /s", all.rate()))},
      {"filter at 0.02 m", "10,000 /s", timed(fmt::format("{:.0f} /s", filter.back().rate()))},
      {"engine at 0.04 m", "-", timed(fmt::format("{:.2g} /s", at_4_cm)),
       "poses of the lattice that are decided, most of them by bounds of many at once"}};
  entry.panels = {{Chart({"poses per second, one thread",
                          {"voxels (m)", Range{0.015, 1.7}, Scale::kLog, kResolutions},
                          {"poses/s", Range{3e3, 3e10}, Scale::kLog},
                          520.0,
                          340.0})
                       .line("filter", Ink::kSecond, by_filter)
                       .dots("", Ink::kSecond, by_filter, 6.0)
                       .line("engine", Ink::kOurs, by_engine)
                       .dots("", Ink::kOurs, by_engine, 6.0)
                       .mark_y("paper", Ink::kPaper, kPaperRate)
                       .svg()}};
  entry.tables = {levels, search};
  entry.differs =
      "The filter counts particle by particle as the paper's does, but in a map of blocks of bits "
      "instead of a hash set, on a faster processor. The engine bounds the overlap of whole groups "
      "of "
      "poses, and counts 64 of those that are left at once.";
  return entry;
}

}  // namespace voxlist::desk
