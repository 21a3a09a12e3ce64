#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace voxlist::viewing {

/// A set of block numbers, one bit each: what one client has still to get. However often a block
/// changes while the client is slow, it stands here once.
class BlockSet {
 public:
  void add(std::uint32_t number);

  /// Adds 0 to count - 1.
  void add_all(std::uint32_t count);

  /// Takes one out. Each has its turn: the next one after the last, and from the beginning after
  /// the highest.
  std::optional<std::uint32_t> take();

  std::size_t size() const { return size_; }
  void clear() { *this = {}; }

 private:
  std::vector<std::uint64_t> words_;
  std::size_t size_ = 0;
  std::size_t next_word_ = 0;
};

}  // namespace voxlist::viewing
