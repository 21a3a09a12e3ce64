#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "voxlist/drawing/picture.h"

namespace voxlist::drawing {

/// A line of a plot, with its name in the legend.
struct PlotSeries {
  std::string name;
  io::Rgb colour;
  std::vector<Eigen::Vector2d> points;
};

/// What stands around a plot.
struct PlotFrame {
  std::string title;
  std::string x_label;
  std::string y_label;
  int width = 800;
  int height = 600;
  /// One unit has the same length on both axes, as a plan needs.
  bool equal_scale = false;
};

/// A line plot on white; axes and ticks follow from the (finite) points.
Picture draw_plot(const PlotFrame& frame, const std::vector<PlotSeries>& series);

/// The values from low to high that an axis is marked at: about `count`, and 1, 2 or 5 times a
/// power of ten apart. None where low is not below high or one of them is not finite.
std::vector<double> plot_ticks(double low, double high, int count);

}  // namespace voxlist::drawing
