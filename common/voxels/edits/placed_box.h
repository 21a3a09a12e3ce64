#pragma once

#include <Eigen/Geometry>

#include "voxlist/geometry/pose.h"

namespace voxlist {

/// What a person says of a box.
enum class EditKind {
  /// What was hit there is forgotten: it is unknown, or free where rays say so.
  kErase,
  /// It is free, whatever is hit there.
  kKeepFree,
  /// It is occupied, whatever rays pass there: a wall that no laser sees.
  kKeepBlocked,
};

/// An upright box in a map. Its edges lie along the axes of its own frame.
struct PlacedBox {
  EditKind kind = EditKind::kErase;
  Eigen::AlignedBox3d box;
  Pose2 T_map_box{};

  /// Whether a point of the map lies in it, its faces included.
  bool contains(const Eigen::Vector3d& point_map) const {
    return box.contains(T_map_box.inverse() * point_map);
  }
};

}  // namespace voxlist
