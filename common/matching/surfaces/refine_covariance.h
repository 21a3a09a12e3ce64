#pragma once

#include <vector>

#include "voxlist/matching/surfaces/correspondences.h"

namespace voxlist::matching {

/// How well the map's surfaces hold a pose (kDof = 3 or 6), as if they stood right where the map
/// has them. Points of one surfel share its error, so many of them tell little more than a few:
/// each surfel counts with the variance of its mean, both parts of which are read off the
/// residuals.
///
/// `start_sigma`: the standard deviations that the pose had before. Where the surfaces hold a
/// direction no better, it stays as unsure. `least_sigma_m`: points scatter at least this much.
template <int kDof>
Square<kDof> covariance_of(const std::vector<Correspondence<kDof>>& correspondences,
                           const Step<kDof>& start_sigma, double least_sigma_m);

}  // namespace voxlist::matching
