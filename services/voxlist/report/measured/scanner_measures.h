#pragma once

#include <array>
#include <vector>

#include "services/voxlist/report/measured/scanner_recording.h"

namespace voxlist::desk {

/// RMS distance of two clouds' points from the best plane through both, for the ceiling (z), the
/// two walls across x, and the two across y. Metres.
struct RandomError {
  double z_m, x_m, y_m;
};
RandomError random_error(const Cloud& first, const Cloud& second);

/// The same of all five surfaces, of the points between two distances from the mirror. Metres.
struct ErrorAtDistance {
  double from_m, to_m;
  double rms_m = 0.0;
  int points = 0;
};

/// Each metre of distance in which there are points enough to tell.
std::vector<ErrorAtDistance> error_by_distance(const Cloud& first, const Cloud& second);

/// Mean error of the distances between pairs of points that are 5.5 to 6.5 m apart.
double error_on_six_metres(const std::vector<ScannerRecording::SeenPoint>& points);

/// Mean distance between truth and what is seen, as it would be 6 m from the mirror.
double error_at_six_metres(const std::vector<ScannerRecording::SeenPoint>& points);

/// Distance from each point of the first cloud to the closest of the second, sorted.
std::vector<double> closest_distances(const Cloud& first, const Cloud& second);

/// Share of the distances in each millimetre, from 0 on; the rest is left out.
std::array<double, 40> by_millimetre(const std::vector<double>& distances_m);

}  // namespace voxlist::desk
