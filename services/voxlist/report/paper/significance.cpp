#include <fmt/core.h>

#include <cmath>

#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/measured/chance.h"
#include "services/voxlist/report/measured/places.h"
#include "services/voxlist/report/measured/statistics.h"
#include "services/voxlist/report/paper/figures.h"
#include "voxlist/matching/localisation/localiser.h"

namespace voxlist::desk {
namespace {

constexpr int kPaperOverlap = 379;
constexpr double kPosesTried = 1e5;

std::string power(double log10) {
  return std::isfinite(log10) ? fmt::format("10^{:.1f}", log10) : "0";
}

// The paper does not tell V, N and n: two that a room or two of its size could have.
Table paper_example() {
  Table table{
      "An overlap of 379 at 0.16 m (the paper tells neither V nor N nor n; these are two "
      "that fit rooms of 20 x 20 x 3 m)",
      {"V", "N", "n", "mean", "sd", "P(X >= 379)", "best of 100,000 poses"},
      {}};
  for (const matching::ChanceModel& model :
       {matching::ChanceModel{296875, 15000, 1500}, matching::ChanceModel{296875, 30000, 2500}}) {
    const double tail = matching::log10_overlap_tail(model, kPaperOverlap);
    table.rows.push_back({fmt::format("{}", model.volume_voxels),
                          fmt::format("{}", model.map_voxels), fmt::format("{}", model.scan_voxels),
                          fmt::format("{:.1f}", matching::overlap_mean(model)),
                          fmt::format("{:.2f}", std::sqrt(matching::overlap_variance(model))),
                          power(tail), power(matching::log10_best_of(tail, kPosesTried))});
  }
  return table;
}

// Share of the wrong poses whose overlap the formula calls significant at 1 %, the number of poses
// tried taken into account.
double called_significant(const ChanceLevel& level) {
  double count = 0.0;
  for (const double overlap : level.overlaps) {
    const double tail =
        matching::log10_overlap_tail(level.model, static_cast<std::int64_t>(overlap));
    count += matching::log10_best_of(tail, kPosesTried) < -2.0;
  }
  return count / static_cast<double>(level.overlaps.size());
}

Table our_levels(const std::vector<ChanceLevel>& levels) {
  Table table{"The same formulas on a scan of this report: at its true pose, and at wrong ones",
              {"eps (m)", "overlap at the true pose", "P(X >= that), best of 100,000",
               "wrong poses called significant (1 %)", "greatest overlap of a wrong pose"},
              {}};
  for (const ChanceLevel& level : levels)
    table.rows.push_back(
        {fmt::format("{:.2f}", level.resolution_m), fmt::format("{}", level.true_overlap),
         power(matching::log10_best_of(
             matching::log10_overlap_tail(level.model, level.true_overlap), kPosesTried)),
         fmt::format("{:.0f} %", 100.0 * called_significant(level)),
         fmt::format("{:.0f}", percentile(level.overlaps, 1.0))});
  return table;
}

}  // namespace

Entry significance(const Scene& scene) {
  const PlacedScan query = scene.queries(1).front();
  const auto levels =
      wrong_overlaps(scene.map().occupied, query, scene.scale().wrong_poses, scene.seed());
  const ChanceLevel& level = levels[3];  // 0.16 m
  matching::LocaliserConfig config;
  config.threads = 1;
  matching::Localiser localiser(scene.map(), config);
  const matching::Localisation found = localiser.locate(query.cloud);
  const double example = matching::log10_overlap_tail({296875, 30000, 2500}, kPaperOverlap);
  Entry entry;
  entry.paper =
      "\"The maximum count for the 0.16 resolution scan alignment shown in Fig. 4 is 379 which is "
      "very significant and so the result may be regarded as reliable.\"";
  entry.setup = fmt::format(
      "The hypergeometric tail in its right form, and the bound K P for the best of K poses, which "
      "the paper leaves out. Wrong poses: {} random ones, more than 1 m off.",
      level.overlaps.size());
  entry.comparisons = {
      {"overlap at 0.16 m", "379", fmt::format("{}", level.true_overlap),
       "of this scan, at its true pose"},
      {"its significance", "\"very significant\"",
       power(matching::log10_overlap_tail(level.model, level.true_overlap)),
       fmt::format("the paper's 379 with V = 296875, N = 30000, n = 2500: {}", power(example))},
      {"wrong poses called significant at 0.16 m", "not said",
       fmt::format("{:.0f} %", 100.0 * called_significant(level)),
       "so the formula alone cannot decide"},
      {"what Voxlist says instead", "-",
       found.modes.empty()
           ? std::string("LOST")
           : fmt::format("{}, probability {:.4f}", matching::name(found.state), found.confidence),
       found.modes.empty()
           ? ""
           : "off by " + metres(distance_m(found.modes.front().T_map_base, query.truth))}};
  Chart chart(
      {"wrong poses that the formula calls significant",
       {"voxels (m)", Range{0.015, 1.7}, Scale::kLog, {0.02, 0.04, 0.08, 0.16, 0.32, 0.64, 1.28}},
       {"share of the wrong poses (%)", Range{0.0, 105.0}},
       460.0,
       280.0});
  std::vector<Eigen::Vector2d> shares;
  for (const ChanceLevel& each : levels)
    shares.emplace_back(each.resolution_m, 100.0 * called_significant(each));
  entry.panels = {{chart.line("measured", Ink::kOurs, shares)
                       .dots("", Ink::kOurs, shares, 6.0)
                       .mark_y("asked for: 1 %", Ink::kPaper, 1.0)
                       .mark_x("the paper's 0.16 m", Ink::kPaper, 0.16)
                       .svg()}};
  entry.tables = {paper_example(), our_levels(levels)};
  entry.differs =
      "The formula takes voxels to be independent. They lie on surfaces, so many wrong poses in a "
      "building are \"significant\", too. Voxlist publishes the value, and decides by a "
      "probability "
      "that compares the best pose with all others that were examined; the next section shows what "
      "it is worth.";
  return entry;
}

}  // namespace voxlist::desk
