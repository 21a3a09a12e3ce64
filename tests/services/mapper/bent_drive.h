#pragma once

#include <cstdint>
#include <vector>

#include "tests/mapping/graph/block_drive.h"
#include "tests/mapping/loops/bent_block.h"
#include "voxlist/mapping/map_builder.h"

namespace voxlist::services {

/// A bent drive round a block, a keyframe a second.
struct BentDrive {
  std::vector<Pose2> truth = mapping::way_round(12.0), bent = mapping::bent(truth);

  std::size_t size() const { return truth.size(); }

  mapping::Keyframe keyframe(std::size_t i) const {
    mapping::Keyframe keyframe{to_pose3(bent[i]), mapping::scan_block(truth[i], i + 1)};
    keyframe.cloud.utime_us = static_cast<std::int64_t>(i + 1) * 1'000'000;
    return keyframe;
  }
};

inline std::vector<Pose2> planar(const std::vector<StampedPose3>& poses) {
  std::vector<Pose2> planar;
  for (const StampedPose3& pose : poses) planar.push_back(to_pose2(pose.pose));
  return planar;
}

}  // namespace voxlist::services
