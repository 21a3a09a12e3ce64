#pragma once

#include <utility>
#include <vector>

#include "voxlist/evaluation/evaluation.h"

namespace voxlist::evaluation {

/// Pairs of (position in the truth, position in the estimate), in the order of the truth's times.
struct PosePairs {
  Association association = Association::kByTime;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
};

/// Finds which estimate belongs to which true pose, as evaluate() says; each is used once. May be
/// empty.
PosePairs associate(const std::vector<StampedPose3>& estimate, const io::PoseTable& truth);

}  // namespace voxlist::evaluation
