#include "voxlist/voxels/counters/cell_store.h"

#include <algorithm>
#include <new>

namespace voxlist {
namespace {

std::uint32_t* zeros(std::size_t count) {
  void* memory = std::calloc(count, sizeof(std::uint32_t));
  if (memory == nullptr) throw std::bad_alloc();
  return static_cast<std::uint32_t*>(memory);
}

}  // namespace

void CellStore::begin(int block_bits, std::size_t most_blocks) {
  forget();
  if (most_blocks + kFirstPlace > room_) make_room(most_blocks + kFirstPlace);
  bits_.end = kFirstPlace;
  bits_.most_places = static_cast<std::uint32_t>(most_blocks + kFirstPlace);
  bits_.is_full = false;
  if (block_bits > room_bits_) {
    places_.reset(zeros(std::size_t{1} << block_bits));
    bits_.places = places_.get();
    room_bits_ = block_bits;
  }
  block_bits_ = block_bits;
}

void CellStore::make_room(std::size_t places) {
  words_ = std::make_unique_for_overwrite<std::uint64_t[]>(places * kWordsInBlock);
  blocks_ = std::make_unique_for_overwrite<std::uint32_t[]>(places);
  bits_.words = words_.get();
  bits_.blocks = blocks_.get();
  std::fill_n(bits_.words, kFirstPlace * kWordsInBlock, std::uint64_t{0});
  room_ = places;
}

void CellStore::forget() {
  for (std::uint32_t i = kFirstPlace; i < bits_.end; ++i) bits_.places[bits_.blocks[i]] = 0;
}

std::size_t CellStore::used_bytes() const {
  constexpr std::size_t kOfBlock = kWordsInBlock * sizeof(std::uint64_t) + sizeof(std::uint32_t);
  return bits_.end * kOfBlock + (sizeof(std::uint32_t) << std::max(block_bits_, 0));
}

}  // namespace voxlist
