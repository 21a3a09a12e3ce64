#include <cmath>

#include "voxlist/drawing/plot.h"
#include "voxlist/evaluation/evaluation.h"

namespace voxlist::evaluation {
namespace {

constexpr io::Rgb kTruth{150, 156, 166};
constexpr io::Rgb kEstimate{255, 92, 72};
constexpr int kWidth = 1000;

drawing::Picture draw_trajectories(const TrajectoryErrors& errors) {
  drawing::PlotSeries truth{"truth", kTruth, {}}, estimate{"estimate", kEstimate, {}};
  for (const MatchedPose& pose : errors.poses) {
    truth.points.emplace_back(pose.truth.x_m, pose.truth.y_m);
    estimate.points.emplace_back(pose.anchored.x_m, pose.anchored.y_m);
  }
  return drawing::draw_plot(
      {"trajectory, first pose anchored", "x (m)", "y (m)", kWidth, 760, true}, {truth, estimate});
}

drawing::Picture draw_error_over_time(const TrajectoryErrors& errors) {
  drawing::PlotSeries error{"position error", kEstimate, {}};
  for (const MatchedPose& pose : errors.poses) {
    const auto elapsed_us = static_cast<double>(pose.utime_us - errors.poses.front().utime_us);
    error.points.emplace_back(elapsed_us * 1e-6, distance_m(pose.truth, pose.anchored));
  }
  return drawing::draw_plot(
      {"position error over time", "time (s)", "error (m)", kWidth, 320, false}, {error});
}

}  // namespace

drawing::Picture draw_errors(const TrajectoryErrors& errors) {
  const drawing::Picture plan = draw_trajectories(errors), over_time = draw_error_over_time(errors);
  drawing::Picture page(kWidth, plan.height() + over_time.height(), {255, 255, 255});
  page.paste(plan, 0, 0);
  page.paste(over_time, 0, plan.height());
  return page;
}

}  // namespace voxlist::evaluation
