#include <fmt/core.h>

#include <functional>

#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/measured/places.h"
#include "services/voxlist/report/run/folder.h"
#include "voxlist/evaluation/evaluation.h"
#include "voxlist/io/files/file.h"

namespace voxlist::desk {
namespace {

using evaluation::ErrorStatistics;
using evaluation::TrajectoryErrors;

Table statistics(const TrajectoryErrors& errors) {
  Table table{"Errors against the truth, as voxlist evaluate tells them",
              {"", "RMSE", "mean", "median", "greatest"},
              {}};
  const auto row = [&](const std::string& name, const ErrorStatistics& e, double scale) {
    table.rows.push_back(
        {name, fmt::format("{:.4f}", e.rmse * scale), fmt::format("{:.4f}", e.mean * scale),
         fmt::format("{:.4f}", e.median * scale), fmt::format("{:.4f}", e.max * scale)});
  };
  const double turn = degrees(1.0);
  row("position, best fit (m)", errors.aligned_m, 1.0);
  row("heading, best fit (deg)", errors.aligned_heading_rad, turn);
  row("position from the first pose on (m)", errors.anchored_m, 1.0);
  row("heading from the first pose on (deg)", errors.anchored_heading_rad, turn);
  if (errors.anchored_3d_m) row("with height (m)", *errors.anchored_3d_m, 1.0);
  row("pose to pose (m)", errors.step_m, 1.0);
  row("pose to pose (deg)", errors.step_rad, turn);
  row("over 1 m and more (%)", errors.per_metre_m, 100.0);
  return table;
}

std::string over_time(const TrajectoryErrors& errors, const std::string& title,
                      const std::string& label, Ink ink,
                      const std::function<double(const evaluation::MatchedPose&)>& error) {
  std::vector<Eigen::Vector2d> line;
  for (const evaluation::MatchedPose& pose : errors.poses)
    line.emplace_back(static_cast<double>(pose.utime_us - errors.poses.front().utime_us) * 1e-6,
                      error(pose));
  return Chart({title, {"time (s)"}, {label}, 900.0, 240.0}).line("", ink, line).svg();
}

std::string plan(const TrajectoryErrors& errors) {
  std::vector<Eigen::Vector2d> truth, ours;
  for (const evaluation::MatchedPose& pose : errors.poses) {
    truth.emplace_back(pose.truth.x_m, pose.truth.y_m);
    ours.emplace_back(pose.anchored.x_m, pose.anchored.y_m);
  }
  return Chart({"both ways, the first poses laid onto each other",
                {"x (m)"},
                {"y (m)"},
                900.0,
                520.0,
                true})
      .line("truth", Ink::kPaper, truth)
      .line("trajectory", Ink::kOurs, ours)
      .svg();
}

}  // namespace

Entry run_errors(const MapFolder& folder, const io::PoseTable& truth,
                 const std::filesystem::path& truth_file) {
  const auto errors = evaluation::evaluate(folder.trajectory, truth);
  if (!errors)
    throw io::FileError(truth_file,
                        "has no pose for any of the trajectory, check that both are of "
                        "the same run");
  Entry entry{"errors", "Errors over time"};
  entry.setup =
      fmt::format("{} of {} true poses have one of the trajectory, matched by {}.", errors->matched,
                  errors->in_truth,
                  errors->association == evaluation::Association::kByTime ? "time" : "scan number");
  entry.panels = {{over_time(*errors, "position error, from the first pose on", "m", Ink::kOurs,
                             [](const auto& p) { return distance_m(p.truth, p.anchored); })},
                  {over_time(*errors, "heading error, from the first pose on", "deg", Ink::kThird,
                             [](const auto& p) { return degrees(turn_rad(p.truth, p.anchored)); })},
                  {plan(*errors)}};
  entry.tables = {statistics(*errors)};
  return entry;
}

}  // namespace voxlist::desk
