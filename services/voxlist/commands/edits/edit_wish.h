#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "voxlist/voxels/edits/placed_box.h"

namespace voxlist::desk {

/// What is to be edited in a map.
struct EditWish {
  std::filesystem::path folder;
  /// A box of this kind between two corners, x, y, z, x, y, z (m); nothing: a box is taken back.
  std::optional<EditKind> kind;
  std::vector<double> corners_m;
  std::int64_t id = 0;

  Eigen::AlignedBox3d box() const {
    const Eigen::Vector3d a(corners_m[0], corners_m[1], corners_m[2]);
    const Eigen::Vector3d b(corners_m[3], corners_m[4], corners_m[5]);
    return {a.cwiseMin(b).eval(), a.cwiseMax(b).eval()};
  }
};

}  // namespace voxlist::desk
