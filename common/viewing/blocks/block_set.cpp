#include "voxlist/viewing/blocks/block_set.h"

#include <bit>

namespace voxlist::viewing {

void BlockSet::add(std::uint32_t number) {
  const std::size_t word = number / 64;
  if (word >= words_.size()) words_.resize(word + 1);
  const std::uint64_t bit = std::uint64_t{1} << (number % 64);
  if ((words_[word] & bit) != 0) return;
  words_[word] |= bit;
  ++size_;
}

void BlockSet::add_all(std::uint32_t count) {
  for (std::uint32_t number = 0; number < count; ++number) add(number);
}

std::optional<std::uint32_t> BlockSet::take() {
  if (size_ == 0) return std::nullopt;
  if (next_word_ >= words_.size()) next_word_ = 0;
  while (words_[next_word_] == 0) next_word_ = (next_word_ + 1) % words_.size();
  std::uint64_t& word = words_[next_word_];
  const int bit = std::countr_zero(word);
  word &= word - 1;
  --size_;
  return static_cast<std::uint32_t>(64 * next_word_ + static_cast<std::size_t>(bit));
}

}  // namespace voxlist::viewing
