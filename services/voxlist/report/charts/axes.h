#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "services/voxlist/report/charts/chart.h"
#include "services/voxlist/report/charts/svg.h"

namespace voxlist::desk {

/// Where values lie on a chart of pixels, and the marks along its axes.
class ChartAxes {
 public:
  /// `low` and `high`: of what is drawn, for axes without a range. `top`: pixels above the axes.
  ChartAxes(const ChartFrame& frame, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
            double top);

  /// The pixel of a value; not finite where a logarithmic axis does not know it.
  Eigen::Vector2d pixel(const Eigen::Vector2d& value) const;

  /// How many pixels a square of this edge has. Of linear axes.
  Eigen::Vector2d pixels(double edge) const;

  /// What the axes show.
  Eigen::Vector2d low() const { return {shown_[0].low, shown_[1].low}; }
  Eigen::Vector2d high() const { return {shown_[0].high, shown_[1].high}; }

  /// Draws grid, marks and labels.
  void draw(Svg& svg) const;

 private:
  double share(int axis, double value) const;
  std::vector<double> ticks(int axis) const;
  void widen();

  const ChartFrame& frame_;
  std::array<Range, 2> shown_;
  Eigen::Vector2d corner_, size_;  // top left of the axes, and how large they are
};

}  // namespace voxlist::desk
