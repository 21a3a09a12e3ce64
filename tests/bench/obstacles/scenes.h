#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/ramps/slab_world.h"

namespace voxlist::bench {

/// What a robot comes upon that drives along x, towards greater x: its near edge is at x = 0.
enum class SceneKind { kFlat, kRampUp, kRampDown, kHole, kKerb, kStairs };

inline constexpr std::array kDrops{SceneKind::kHole, SceneKind::kKerb, SceneKind::kStairs};

std::string name_of(SceneKind kind);

struct Scene {
  SlabWorld world;
  /// Where the floor ends, on the robot's way.
  Eigen::Vector2d edge{0.0, 0.0};
};

/// A corridor of 6 m with the scene across it. Hole: 0.3 x 0.3 m, 0.15 to 1 m deep. Kerb: 0.12 to
/// 0.2 m down, turned by up to 25 deg. Stairs: eight steps down, 0.16 to 0.19 m each. Ramps: 5 deg.
Scene make_scene(SceneKind kind, std::uint64_t seed);

/// Boxes on a flat floor within 2 m of x = 0.
SlabWorld flat_with(const std::vector<Slab>& things);

/// An upright block.
Slab block(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

}  // namespace voxlist::bench
