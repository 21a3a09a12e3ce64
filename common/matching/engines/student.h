#pragma once

#include <algorithm>

#include "voxlist/geometry/elementary.h"

// Motions err by Student's distribution: mostly as is expected of them, and now and then by far
// more, as when wheels slip. Distances are squares in units of the expected standard deviations
// (mahalanobis2), of three coordinates.

namespace voxlist::matching {

/// Degrees of freedom: the fewer, the less surprising is a large error. A judgement.
inline constexpr double kFreedom = 4.0;

/// Logarithm of the density, beside that of no error at all.
inline double log_student(double distance2) {
  return -0.5 * (kFreedom + 3.0) * elementary::log1p(distance2 / kFreedom);
}

/// The factor, at least 1, by which a covariance must grow before it expects an error so far off.
inline double student_variance(double distance2) {
  return std::max(1.0, (kFreedom + distance2) / (kFreedom + 3.0));
}

}  // namespace voxlist::matching
