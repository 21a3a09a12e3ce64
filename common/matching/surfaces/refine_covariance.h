#pragma once

#include <vector>

#include "voxlist/matching/surfaces/correspondences.h"

namespace voxlist::matching {

/// How well the map's surfaces hold a pose (kDof = 3 or 6), as if they stood right where the map
/// has them. Points of one surfel share its error, so many of them tell little more than a few:
/// each surfel counts with the variance of its mean, both parts of which are read off the
/// residuals.
///
/// `before`: the covariance that the pose had before. Where the surfaces hold a direction no
/// better, it stays as unsure. `doubted`: surfaces may not be what they seem, as in maps of few
/// points; what few of them alone tell is not believed, and no more than the places that they are
/// in agree on. `lines_hold`: planes of what may be a line (Surfel::of_line) tell, too.
/// `least_sigma_m`: points scatter at least this much.
template <int kDof>
Square<kDof> covariance_of(const std::vector<Correspondence<kDof>>& correspondences,
                           const Square<kDof>& before, double least_sigma_m, bool doubted,
                           bool lines_hold);

}  // namespace voxlist::matching
