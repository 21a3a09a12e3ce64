#include <fmt/core.h>

#include <array>

#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/measured/statistics.h"
#include "services/voxlist/report/run/folder.h"

namespace voxlist::desk {
namespace {

using matching::LocalisationState;

constexpr const char* kOlder =
    "The folder has no scans.csv: its scans were not localised (--use-poses), or it was made by a "
    "robot or an older Voxlist. voxlist map writes it.";

double seconds(const ScanRow& row, const std::vector<ScanRow>& rows) {
  return static_cast<double>(row.utime_us - rows.front().utime_us) * 1e-6;
}

}  // namespace

Entry run_states(const MapFolder& folder) {
  Entry entry{"states", "States and probabilities over time"};
  if (!folder.scans || folder.scans->empty()) {
    entry.differs = kOlder;
    return entry;
  }
  const std::vector<ScanRow>& rows = *folder.scans;
  std::array<std::vector<Eigen::Vector2d>, 3> by_state;
  for (const ScanRow& row : rows)
    by_state[static_cast<std::size_t>(row.state)].emplace_back(seconds(row, rows), row.probability);
  entry.setup =
      "What was said of each scan when it came; where scans have their place at last, the "
      "trajectory says.";
  entry.panels = {{Chart({"probability that the first mode is right",
                          {"time (s)"},
                          {"probability", Range{-0.03, 1.05}},
                          900.0,
                          260.0})
                       .dots("TRACKING", Ink::kSecond, by_state[2], 4.5)
                       .dots("AMBIGUOUS", Ink::kPaper, by_state[1], 6.0)
                       .dots("LOST", Ink::kThird, by_state[0], 6.0)
                       .svg()}};
  Table table{"", {"state", "scans", "probability, mean"}, {}};
  for (const LocalisationState state :
       {LocalisationState::kTracking, LocalisationState::kAmbiguous, LocalisationState::kLost}) {
    std::vector<double> said;
    for (const Eigen::Vector2d& at : by_state[static_cast<std::size_t>(state)])
      said.push_back(at.y());
    table.rows.push_back({matching::name(state), fmt::format("{}", said.size()),
                          said.empty() ? "-" : fmt::format("{:.4f}", moments(said).mean)});
  }
  entry.tables = {table};
  return entry;
}

Entry run_times(const MapFolder& folder) {
  Entry entry{"latency", "How long scans took"};
  if (!folder.scans || folder.scans->empty()) {
    entry.differs = kOlder;
    return entry;
  }
  const std::vector<ScanRow>& rows = *folder.scans;
  std::vector<double> all;
  std::vector<Eigen::Vector2d> over_time;
  for (const ScanRow& row : rows) {
    all.push_back(row.elapsed_ms);
    over_time.emplace_back(seconds(row, rows), std::max(0.1, row.elapsed_ms));
  }
  entry.setup =
      "From the scan in memory to the map that has it, by the wall's clock of the machine "
      "that made the map. Reading files, closing loops at the end and the OctoMap are not "
      "in it.";
  entry.panels = {
      {Chart({"time for each scan", {"time (s)"}, {"ms", std::nullopt, Scale::kLog}, 900.0, 260.0})
           .dots("", Ink::kOurs, over_time, 3.5)
           .svg()}};
  Table table{"", {"percentile", "ms"}, {}};
  for (const auto& [name, share] :
       {std::pair{"50", 0.5}, std::pair{"90", 0.9}, std::pair{"99", 0.99}, std::pair{"100", 1.0}})
    table.rows.push_back({name, timed(fmt::format("{:.1f}", percentile(all, share)))});
  entry.tables = {table};
  return entry;
}

}  // namespace voxlist::desk
