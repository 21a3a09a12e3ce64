#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace voxlist::bus {

/// A message as an enemy or a broken cable would send it.
struct Forgery {
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

/// Makes messages for every channel in turn: whole ones with believable and absurd numbers,
/// truncated, lengthened, with flipped bits, with absurd lengths written over them, of the wrong
/// type, and pure noise. The same seed gives the same messages.
class Forge {
 public:
  explicit Forge(std::uint32_t seed);

  Forgery next();

  /// A whole message of that channel whose lengths are right and whose values are random.
  std::vector<std::uint8_t> whole(std::size_t channel);

  /// The channels that it forges, without prefix.
  static const std::vector<std::string>& channels();

 private:
  std::size_t below(std::size_t limit);

  std::mt19937 random_;
  std::size_t made_ = 0;
};

}  // namespace voxlist::bus
