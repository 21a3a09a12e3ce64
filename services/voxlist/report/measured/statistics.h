#pragma once

#include <vector>

#include "services/voxlist/report/charts/chart.h"

namespace voxlist::desk {

/// Mean and standard deviation of values. Both 0 where there are none.
struct Moments {
  double mean = 0.0, sd = 0.0;
};
Moments moments(const std::vector<double>& values);

/// The value that a share of the values, 0..1, do not exceed; 0 where there are none.
double percentile(std::vector<double> values, double share);

/// Density of the normal distribution.
double normal_density(double value, const Moments& of);

/// Kolmogorov's distance: the greatest difference between the share of the values up to any value,
/// and that of a normal distribution. Of `values` from the distribution itself it is below
/// 1.36 / sqrt(count) in 95 of 100 cases.
double distance_from_normal(std::vector<double> values, const Moments& of);

/// Shares of the values in `bins` bars of equal width from lowest to highest.
std::vector<Bar> histogram(const std::vector<double>& values, int bins);

/// The normal distribution as a line over such bars of the given width.
std::vector<Eigen::Vector2d> normal_curve(const Moments& of, double low, double high, double width);

}  // namespace voxlist::desk
