#include "voxlist/voxels/edits/block_edits.h"

#include <algorithm>
#include <cmath>

#include "voxlist/geometry/elementary.h"

namespace voxlist {
namespace {

// Edge of the cubes by which boxes are found (m), or that of a block where it is larger.
constexpr double kCube_m = 2.0;

template <class Visit>
void for_each_in(const VoxelBox& box, const Visit& visit) {
  for (std::int32_t z = box.lowest.z; z <= box.highest.z; ++z)
    for (std::int32_t y = box.lowest.y; y <= box.highest.y; ++y)
      for (std::int32_t x = box.lowest.x; x <= box.highest.x; ++x) visit(Voxel{x, y, z});
}

void take(const VoxelBlock& cells, VoxelBlock& from) {
  for (std::size_t z = 0; z < from.size(); ++z) from[z] &= ~cells[z];
}

void add(const VoxelBlock& cells, VoxelBlock& to) {
  for (std::size_t z = 0; z < to.size(); ++z) to[z] |= cells[z];
}

}  // namespace

BlockEdits::BlockEdits(const std::vector<PlacedBox>& boxes, double resolution_m)
    : resolution_m_(resolution_m),
      cube_(std::max(1, static_cast<std::int32_t>(kCube_m / (kBlockEdge * resolution_m)))) {
  for (const PlacedBox& placed : boxes) {
    const auto number = static_cast<std::uint32_t>(boxes_.size());
    boxes_.push_back(prepared(placed));
    const VoxelBox blocks = blocks_about(boxes_.back());
    for_each_in({cube_of(blocks.lowest), cube_of(blocks.highest)}, [&](const Voxel& cube) {
      const std::uint32_t at = cubes_.number(cube);
      if (at == boxes_in_.size()) boxes_in_.emplace_back();
      boxes_in_[at].push_back(number);
    });
  }
}

BlockEdits::Box BlockEdits::prepared(const PlacedBox& placed) {
  const Pose2 T_box_map = placed.T_map_box.inverse();
  const auto [sine, cosine] = elementary::sine_cosine(T_box_map.yaw_rad);
  return {placed, sine, cosine, T_box_map.x_m, T_box_map.y_m};
}

Voxel BlockEdits::cube_of(const Voxel& block) const {
  return {floor_div(block.x, cube_), floor_div(block.y, cube_), floor_div(block.z, cube_)};
}

VoxelBox BlockEdits::blocks_about(const Box& box) const {
  Eigen::AlignedBox3d about;
  for (int corner = 0; corner < 8; ++corner)
    about.extend(box.placed.T_map_box *
                 box.placed.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  const double reach_m = (kVoxelLimit - kBlockEdge) * resolution_m_;
  const auto block_at = [&](const Eigen::Vector3d& point) -> Voxel {
    return block_of(voxel_at(point.cwiseMax(-reach_m).cwiseMin(reach_m).eval(), resolution_m_));
  };
  return {block_at(about.min()), block_at(about.max())};
}

BlockEdits::Cells BlockEdits::cells_of(const Voxel& block) const {
  Cells cells;
  const std::uint32_t cube = cubes_.find(cube_of(block));
  if (cube == Numbering<Voxel>::kNone) return cells;
  for (const std::uint32_t number : boxes_in_[cube]) {
    const VoxelBlock inside = cells_of(boxes_[number], block);
    for (VoxelBlock& kind : cells.of_kind) take(inside, kind);
    add(inside, cells.of(boxes_[number].placed.kind));
  }
  return cells;
}

// A box is upright: it has the same cells in each layer that it reaches.
VoxelBlock BlockEdits::cells_of(const Box& box, const Voxel& block) const {
  const Eigen::Vector3d &low = box.placed.box.min(), &high = box.placed.box.max();
  const Voxel first{block.x * kBlockEdge, block.y * kBlockEdge, block.z * kBlockEdge};
  std::uint64_t layer = 0;
  for (int bit = 0; bit < kBlockEdge * kBlockEdge; ++bit) {
    const Eigen::Vector3d p =
        center({first.x + bit % kBlockEdge, first.y + bit / kBlockEdge, 0}, resolution_m_);
    const double x = box.x_m + box.cosine * p.x() - box.sine * p.y();
    const double y = box.y_m + box.sine * p.x() + box.cosine * p.y();
    const bool is_in = x >= low.x() && x <= high.x() && y >= low.y() && y <= high.y();
    layer |= std::uint64_t{is_in} << bit;
  }
  VoxelBlock cells{};
  for (std::int32_t z = 0; z < kBlockEdge; ++z) {
    const double height_m = center({0, 0, first.z + z}, resolution_m_).z();
    if (height_m >= low.z() && height_m <= high.z()) cells[static_cast<std::size_t>(z)] = layer;
  }
  return cells;
}

std::vector<Voxel> BlockEdits::blocks_of(EditKind kind) const {
  Numbering<Voxel> blocks;
  for (const Box& box : boxes_)
    if (box.placed.kind == kind)
      for_each_in(blocks_about(box), [&](const Voxel& block) { blocks.number(block); });
  return blocks.keys();
}

}  // namespace voxlist
