#pragma once

#include <array>
#include <vector>

#include "voxlist/voxels/edits/placed_box.h"
#include "voxlist/voxels/numbering.h"
#include "voxlist/voxels/voxel_map.h"

namespace voxlist {

/// Which cells of a lattice lie in boxes, block by block: those whose centres do. Where boxes
/// overlap, the last one says what a cell is.
class BlockEdits {
 public:
  /// A block costs what the boxes near it cost, however many there are elsewhere.
  BlockEdits(const std::vector<PlacedBox>& boxes, double resolution_m);

  /// Cells of a block, by the kind of their box; none is of two kinds.
  struct Cells {
    std::array<VoxelBlock, 3> of_kind{};

    VoxelBlock& of(EditKind kind) { return of_kind[static_cast<std::size_t>(kind)]; }
    const VoxelBlock& of(EditKind kind) const { return of_kind[static_cast<std::size_t>(kind)]; }
  };

  Cells cells_of(const Voxel& block) const;

  /// The blocks that boxes of a kind may have cells in, each once.
  std::vector<Voxel> blocks_of(EditKind kind) const;

 private:
  // A box as blocks see it: what takes points of the map into its frame.
  struct Box {
    PlacedBox placed;
    double sine, cosine, x_m, y_m;
  };

  static Box prepared(const PlacedBox& placed);
  VoxelBox blocks_about(const Box& box) const;
  Voxel cube_of(const Voxel& block) const;
  VoxelBlock cells_of(const Box& box, const Voxel& block) const;

  double resolution_m_;
  std::int32_t cube_;  // blocks along a cube's edge
  std::vector<Box> boxes_;
  // Cubes of blocks that boxes reach into, and the boxes of each, by number.
  Numbering<Voxel> cubes_;
  std::vector<std::vector<std::uint32_t>> boxes_in_;
};

}  // namespace voxlist
