#pragma once

#include <cstdint>
#include <string>
#include <vector>
#include <voxlist/voxel_block_t.hpp>

namespace voxlist::bus {

/// Blocks of a map: of its voxels, and of its cells that rays passed.
struct MapBlocks {
  std::vector<voxel_block_t> occupied, passed;

  std::size_t size() const { return occupied.size() + passed.size(); }
};

/// Blocks without the words of them that are 0: about half of their memory. A large map waits so
/// until it is sent, and until it is whole again.
class PackedBlocks {
 public:
  explicit PackedBlocks(const MapBlocks& blocks);

  MapBlocks unpacked() const;
  std::size_t size() const { return std::size_t{occupied_} + passed_; }

 private:
  std::uint32_t occupied_, passed_;
  std::string bytes_;
};

}  // namespace voxlist::bus
