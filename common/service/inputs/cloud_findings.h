#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "voxlist/geometry/cloud.h"

namespace voxlist::service {

/// Something that is wrong with a cloud.
struct CloudFinding {
  std::string key;
  std::string sentence;
  /// Whether the cloud is of no use.
  bool refuses = false;
};

/// What a cloud tells by itself: its frame, its extent, how many points it has. `dropped_points`
/// were left out already, being not finite or farther than any measurement. Cost: 1000 points at
/// most are looked at.
std::vector<CloudFinding> cloud_findings(const std::string& frame_id, const Cloud& cloud,
                                         std::int64_t dropped_points);

}  // namespace voxlist::service
