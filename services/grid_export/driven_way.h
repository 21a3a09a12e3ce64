#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>
#include <voxlist/keyframe_t.hpp>
#include <voxlist/pose_t.hpp>
#include <voxlist/uncertain_pose_t.hpp>

#include "voxlist/voxels/numbering.h"

namespace voxlist::services {

/// Where the robot drove in the mapper's map: at its keyframes, which are asked for where they were
/// missed, and since this service started at its poses as well. A place where it was before is kept
/// once, so that hours on the same ways cost nothing.
class DrivenWay {
 public:
  /// Which map the mapper has. Keyframes of another one, or that were moved since, are forgotten.
  struct Map {
    std::int64_t map_id = 0, moves = 0, keyframes = 0;
  };
  void follow(const Map& map);

  /// True: the way has grown.
  bool take(const keyframe_t& message);
  void take(const pose_t& message);
  bool take(const uncertain_pose_t& message);

  /// The first keyframe to ask for now, at most once a second.
  std::optional<std::int32_t> due(std::int64_t now_us);

  /// Positions of base in the map: at its keyframes, in their order.
  std::vector<Eigen::Vector3d> keyframes() const;

  /// The same at its poses: parts of its way that were new then, each without a gap.
  const std::vector<std::vector<Eigen::Vector3d>>& poses() const { return poses_; }

 private:
  void forget_poses();

  Map map_;
  std::vector<std::optional<Eigen::Vector3d>> keyframes_;
  std::size_t first_missing_ = 0;
  std::optional<std::int64_t> asked_us_;
  std::int64_t now_us_ = 0;
  // POSE tells the height, POSE_COVARIANCE the map.
  std::int64_t pose_utime_us_ = 0;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  std::vector<std::vector<Eigen::Vector3d>> poses_;
  Numbering<Voxel> places_;                // where poses were
  std::optional<Eigen::Vector3d> newest_;  // of the poses that were looked at
  bool is_newest_kept_ = false;
};

}  // namespace voxlist::services
