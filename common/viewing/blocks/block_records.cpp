#include "voxlist/viewing/blocks/block_records.h"

#include <bit>
#include <cstring>

namespace voxlist::viewing {
namespace {

static_assert(std::endian::native == std::endian::little, "records are written as they lie");

template <class T>
void append(T value, std::vector<std::uint8_t>& to) {
  const std::size_t at = to.size();
  to.resize(at + sizeof value);
  std::memcpy(to.data() + at, &value, sizeof value);
}

std::uint8_t layers_of(const VoxelBlock& block) {
  unsigned layers = 0;
  for (std::size_t z = 0; z < block.size(); ++z) layers |= (block[z] != 0 ? 1U : 0U) << z;
  return static_cast<std::uint8_t>(layers);
}

// A map reaches 10 km (kMapReach_m), which is 31,250 blocks of the smallest detail, 0.04 m.
void append_record(const Voxel& position, const VoxelBlock& block, std::uint32_t changed_s,
                   std::vector<std::uint8_t>& to) {
  for (const std::int32_t part : {position.x, position.y, position.z})
    append(static_cast<std::int16_t>(part), to);
  append(layers_of(block), to);
  append(std::uint8_t{0}, to);
  append(changed_s, to);
  for (const std::uint64_t layer : block)
    if (layer != 0) append(layer, to);
}

}  // namespace

std::vector<std::uint8_t> take_records(const MapLevel& level, std::size_t most, BlockSet& blocks) {
  std::vector<std::uint8_t> records;
  records.reserve(most * 48);
  for (std::size_t i = 0; i < most; ++i) {
    const auto number = blocks.take();
    if (!number) break;
    append_record(level.positions.key(*number), level.blocks[*number], level.changed_s[*number],
                  records);
  }
  return records;
}

}  // namespace voxlist::viewing
